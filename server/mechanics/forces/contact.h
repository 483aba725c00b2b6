// Frictionless penalty contact of vertices against triangle surfaces. A vertex x that has penetrated a surface is
// pushed back to its nearest point c,
//   f = k (c - x)  [N],  E = k |c - x|^2 / 2  [J],
// along the surface normal. A deformable surface takes the opposite force, distributed to the triangle's corners by the
// barycentric coordinates of c: momentum and angular momentum are conserved. k = load/depth [N/m]: `load` [N] on one
// vertex penetrates by `depth` [m]; the default load is the weight of the heaviest body.
// Limits: contact is lost beyond a penetration of 10 depths; at speed v [m/s] the time step must stay below
// 10 depth/v, and k above m v^2/depth^2. Edge-edge contact is not detected: for crossing edges, add the same contact
// with the two bodies exchanged. There is no contact behind the boundary of an open surface.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_

#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {

class Contact final : public Force {
 public:
  // INVALID_ARGUMENT if a surface has no triangles, is skinned (a surface is deformable, driven or at rest), or is one
  // of the bodies.
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
    Points rest;                // rest positions [m]; empty if deformable
    TriangleTree::Boxes boxes;  // of the tree at rest; empty if deformable
    int first_vertex, vertices;
    int pose;  // -1 if it does not move
    bool deformable() const { return first_vertex >= 0; }
  };
  // A vertex in contact: behind a surface.
  struct Touch {
    int vertex;
    Eigen::Vector3d offset;  // c - x [m]
    const Surface* surface;
    Eigen::Vector3i corners;  // of the nearest triangle: simulated vertices if the surface is deformable
    Eigen::Vector3d weights;  // barycentric coordinates of c
  };
  explicit Contact(std::string name) : Force(std::move(name)) {}
  static Surface MakeSurface(const BodyModel& body);
  template <typename Visitor>
  void ForEachTouch(const EvalContext& at, const Visitor& visit) const;

  std::vector<int> vertices_;
  std::vector<Surface> surfaces_;
  double stiffness_ = 0;  // [N/m]
  double reach_ = 0;      // largest penetration that is detected [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CONTACT_H_
