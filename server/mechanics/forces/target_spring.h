// Springs and dampers between vertices and targets,
//   f = k (c - x) + 2 zeta sqrt(k m) (c' - v)  [N],  E = k |c - x|^2 / 2  [J],
// k the stiffness [N/m], zeta the damping ratio, m the vertex's mass [kg], c the target [m]: the vertex's rest position
// plus a displacement, one point for all, or the point of a surface that is nearest at rest, which moves with the
// surface if that is driven. Scaled by the breath, c = rest + s (target - rest), s = breath_force signal(t).
// Conservative if zeta is 0.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class TargetSpring final : public Force {
 public:
  // Returns null, and reports it, if no vertex is free or the stiffness is 0. INVALID_ARGUMENT if there is no target,
  // if `vertices` are given for several bodies, or if the surface is deformable, skinned or has no triangles.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::TargetSpring& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddDamping(const EvalContext& at, Eigen::VectorXd& c) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return damping_ratio_ == 0; }

 private:
  struct VertexSpring {
    int vertex;
    double damping;                // [N s/m]
    Eigen::Vector3d rest, target;  // at rest [m]
  };
  struct Target {
    Eigen::Vector3d position, velocity;  // [m], [m/s]
  };
  explicit TargetSpring(std::string name) : Force(std::move(name)) {}
  absl::Status AddVertices(const v1::TargetSpring& scene, int body, std::string_view path, ModelBuilder& builder);
  absl::Status FindTargets(const v1::TargetSpring& scene, std::string_view path, const ModelBuilder& builder);
  absl::Status FindSurfaceTargets(const v1::TargetSpring& scene, std::string_view path, const ModelBuilder& builder);
  Target TargetOf(const VertexSpring& spring, const EvalContext& at) const;

  std::vector<VertexSpring> springs_;
  double stiffness_ = 0;  // [N/m]
  double damping_ratio_ = 0;
  int pose_ = -1;  // of the driven surface; -1: the targets are fixed
  bool scaled_by_breath_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_
