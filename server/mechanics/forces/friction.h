// Viscous damping proportional to mass and velocity: f = -rate m v [N], rate [1/s]. Thesis equation 2.1 with its
// coefficient g = rate m.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_FRICTION_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_FRICTION_H_

#include "server/mechanics/block_force.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Friction final : public BlockForce {
 public:
  // Returns null, and reports it, if the rate is 0.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Friction& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  void AddDamping(const EvalContext&, Eigen::VectorXd& c) const override { c += coefficient_; }
  // The coefficient g, one per simulated vertex [N s/m].
  const Eigen::VectorXd& coefficient() const { return coefficient_; }

 private:
  explicit Friction(std::string name) : BlockForce(std::move(name)) {}

  Eigen::VectorXd coefficient_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_FRICTION_H_
