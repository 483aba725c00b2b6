// The volume that surfaces bound, its rate, and how it answers to each vertex.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_

#include <string>
#include <string_view>
#include <vector>

#include "server/mechanics/breathing/chamber_kernel.h"
#include "server/mechanics/model_builder.h"
#include "server/mechanics/skinning/body_points.h"

namespace phrenic {

// What has been read at one instant, so that the measures and forces that ask for the same surface go through it once.
// For one thread.
class ChamberReadings {
 public:
  enum class What { kVolume, kFlowToo };
  // Null where the chamber of that key has not been read, or less of it.
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

// V = integral of h n.dA over the triangles [m^3], h the height over a plane with the unit normal n; by the divergence
// theorem the volume that a closed surface encloses, whatever the plane, and the volume between an open one and the
// plane. A triangle abc has (h_a + h_b + h_c)/6 n.((b - a) x (c - a)): exact, and so is the rate dV/dt, its derivative
// along the velocities. A vertex' area vector is a_i = sum (b - a) x (c - a)/6 over its triangles [m^2]: a pressure p
// inside pushes it by p a_i, and a_i = dV/dx_i but on the border of an open surface. Immutable; any number of threads
// may call. Allocates only as BodyPoints does.
class Chamber {
 public:
  // Adds triangles whose normals point out of the chamber (side 1) or into it (side -1). INVALID_ARGUMENT where none is
  // chosen.
  absl::Status Add(const v1::SurfacePatch& scene, double side, std::string_view path, const ModelBuilder& builder);
  // Every patch is there. INVALID_ARGUMENT where the normal has no direction.
  absl::Status SetPlane(const v1::Plane* scene, std::string_view path);

  // Of equal chambers once where the instant keeps readings. Volume and flow in one pass, for twice the price [m^3].
  double Volume(const EvalContext& at) const;
  ChamberReading Read(const EvalContext& at) const;
  double rest_volume() const { return rest_volume_; }
  // f += scale a, 3 x simulated vertices.
  void AddAreas(const EvalContext& at, double scale, MutablePoints f) const;
  // Returns a, 3 x simulated vertices, valid until the next call with the same scratch memory.
  const Points& AreaVectors(const EvalContext& at) const;
  // Visits the corners of every simulated triangle with their places among the simulated vertices.
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
  bool pushes() const;  // some of it is simulated
  // Simulated throughout, and closed or with a border that is fixed or driven: a pressure on it has an energy, -p V.
  bool conserves(const Model& model) const;

 private:
  struct Part {
    BodyPoints points;
    Triangles triangles;                  // of the body
    std::vector<TrianglePacket> packets;  // the same
    std::vector<int> border;              // vertices of the body
    double side;
  };
  double VolumeAtRest() const;
  ChamberReading Sum(ChamberReadings::What what, const EvalContext& at) const;

  std::string key_;  // the same for chambers that are the same
  std::vector<Part> parts_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // rows: two in the plane, and the normal
  double height_ = 0;                                   // of the plane along its normal [m]
  double rest_volume_ = 0;                              // [m^3]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_H_
