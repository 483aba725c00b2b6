// Vertices drawn to targets by springs and dampers: f = k (c - x) + 2 zeta sqrt(k m) (c' - v) [N], c the target: the
// vertex's rest position moved by a displacement, one point for all, or the point of a surface that is nearest at rest,
// carried along where that surface is driven. With the breath c = rest + s (target - rest), s = breath_force signal(t).
// Energy k |c - x|^2 / 2; it is all there is where zeta is 0.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class TargetSpring final : public Force {
 public:
  // Null where no vertex is free or the stiffness is 0.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::TargetSpring& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddDamping(const EvalContext& at, Eigen::VectorXd& c) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return damping_ratio_ == 0; }

 private:
  struct Draw {
    int vertex;
    double damping;                // [N s/m]
    Eigen::Vector3d rest, target;  // [m]; both at rest
  };
  // Where a target is and how fast it moves.
  struct Aim {
    Eigen::Vector3d place, velocity;  // [m], [m/s]
  };
  explicit TargetSpring(std::string name) : Force(std::move(name)) {}
  absl::Status AddDraws(const v1::TargetSpring& scene, int body, std::string_view path, ModelBuilder& builder);
  absl::Status FindTargets(const v1::TargetSpring& scene, std::string_view path, const ModelBuilder& builder);
  absl::Status FindSurfaceTargets(const v1::TargetSpring& scene, std::string_view path, const ModelBuilder& builder);
  Aim AimOf(const Draw& draw, const EvalContext& at) const;

  std::vector<Draw> draws_;
  double stiffness_ = 0;  // [N/m]
  double damping_ratio_ = 0;
  int pose_ = -1;  // of the surface that carries the targets; -1: they stand still
  bool breathes_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_TARGET_SPRING_H_
