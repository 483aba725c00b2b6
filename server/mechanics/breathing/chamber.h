// The volume bounded by surfaces, its rate of change, and its derivative by each vertex.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_

#include <string>
#include <string_view>
#include <vector>

#include "server/mechanics/breathing/chamber_kernel.h"
#include "server/mechanics/model_builder.h"
#include "server/mechanics/skinning/body_points.h"

namespace phrenic {

// Cache of chamber readings at one moment, so that measures and forces with the same surface evaluate it once. Not
// thread-safe.
class ChamberReadings {
 public:
  enum class What { kVolume, kFlowToo };
  // Returns null if there is no reading of the chamber with that key, or only its volume if the flow is requested.
  const ChamberReading* Find(const std::string& key, What what) const;
  void Add(const std::string& key, What what, const ChamberReading& reading) { kept_.push_back({key, what, reading}); }

 private:
  struct Kept {
    std::string key;
    What what;
    ChamberReading reading;
  };
  std::vector<Kept> kept_;
};

// A set of surface patches and a plane. The volume is V = integral of h n.dA over the triangles [m^3], h the height
// above the plane and n its unit normal. By the divergence theorem this is the enclosed volume of a closed surface, for
// any plane, and the volume between an open surface and the plane. A triangle abc contributes
//   (h_a + h_b + h_c)/6 n.((b - a) x (c - a)),
// which is exact, as is the rate dV/dt, its derivative along the velocities. The area vector of vertex i is
// a_i = sum (b - a) x (c - a)/6 over its triangles [m^2]: an internal pressure p exerts the force p a_i [N] on it, and
// a_i = dV/dx_i except on the boundary of an open surface. Immutable once it is set up, and thread-safe, for threads
// with scratch memory of their own. Allocates only as BodyPoints does.
class Chamber {
 public:
  // Adds a patch whose normals point out of the chamber (side 1) or into it (side -1). INVALID_ARGUMENT if it selects
  // no triangle.
  absl::Status Add(const v1::SurfacePatch& scene, double side, std::string_view path, const ModelBuilder& builder);
  // Sets the plane; null: perpendicular to z through the mean of the boundary vertices at rest. Requires: all patches
  // are added. INVALID_ARGUMENT if the normal is zero.
  absl::Status SetPlane(const v1::Plane* scene, std::string_view path);

  // Return the volume [m^3], and the volume and flow in one pass at twice the cost. Equal chambers are evaluated once
  // if the context has ChamberReadings.
  double Volume(const EvalContext& at) const;
  ChamberReading Read(const EvalContext& at) const;
  double rest_volume() const { return rest_volume_; }
  // Adds `scale` times the area vectors to f, 3 x simulated vertices.
  void AddAreas(const EvalContext& at, double scale, MutablePoints f) const;
  // Returns the area vectors [m^2], 3 x simulated vertices, valid until the next call with the same scratch memory.
  const Points& AreaVectors(const EvalContext& at) const;
  // Calls `visit` with the corners of each triangle of a deformable body, as indices of simulated vertices.
  template <typename Visitor>
  void ForEachSimulated(const Visitor& visit) const {
    for (const Part& part : parts_) {
      const int first = part.points.first_vertex();
      if (first < 0) continue;
      for (Eigen::Index t = 0; t < part.triangles.cols(); ++t) {
        visit(Eigen::Vector3i(part.triangles.col(t).array() + first));
      }
    }
  }

  int triangles() const;
  bool pushes() const;  // true if part of the surface is deformable
  // True if a constant pressure on it has an energy, -p V [J]: all of it is deformable, and it is closed or its
  // boundary is fixed or driven.
  bool conserves(const Model& model) const;

 private:
  struct Part {
    BodyPoints points;
    Triangles triangles;                  // of the body
    std::vector<TrianglePacket> packets;  // of these triangles
    std::vector<int> border;              // boundary vertices, indices of the body
    double side;                          // 1 or -1
  };
  double VolumeAtRest() const;
  ChamberReading Sum(ChamberReadings::What what, const EvalContext& at) const;

  std::string key_;  // equal for equal chambers
  std::vector<Part> parts_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // rows: two in the plane, and the normal
  double height_ = 0;                                   // of the plane along its normal [m]
  double rest_volume_ = 0;                              // [m^3]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_
