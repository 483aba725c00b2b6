// Bodies slide on surfaces: a vertex x that is behind a surface is pulled to the nearest point c of it,
// f = k (c - x) [N], along the surface's normal and so without friction; a deformable surface takes the opposite force,
// shared by where c lies in its triangle. E = k |c - x|^2 / 2: forces follow from it, momentum and angular momentum are
// kept. k = load/depth [N/m], so that `load` on one vertex sinks in by `depth`; default load is the weight of the
// heaviest body. A vertex more than ten depths behind has got through and is let go: at speed v [m/s] the time step
// must stay below 10 depth/v, and k above m v^2/depth^2. Vertices against triangles: for edges that cross, name the two
// bodies the other way round as well. Behind the border of an open surface there is no contact.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_

#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {

class Contact final : public Force {
 public:
  // Surfaces are deformable, driven or at rest.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Contact& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  struct Surface {
    TriangleTree tree;
    Points rest;                // of what is not deformable, as it rests
    TriangleTree::Boxes boxes;  // the same
    int first_vertex, vertices;
    int pose;
    bool deformable() const { return first_vertex >= 0; }
  };
  // A vertex behind a surface.
  struct Touch {
    int vertex;
    Eigen::Vector3d offset;  // c - x [m]
    const Surface* surface;
    Eigen::Vector3i corners;  // of the triangle: simulated vertices, where the surface is deformable
    Eigen::Vector3d weights;
  };
  explicit Contact(std::string name) : Force(std::move(name)) {}
  static Surface MakeSurface(const BodyModel& body);
  template <typename Visitor>
  void ForEachTouch(const EvalContext& at, const Visitor& visit) const;

  std::vector<int> vertices_;
  std::vector<Surface> surfaces_;
  double stiffness_ = 0;  // [N/m]
  double reach_ = 0;      // [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_
