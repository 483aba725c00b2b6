// Weight: f = m g [N], E = -m g.x [J], m the vertex's mass [kg].
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_

#include "server/mechanics/forces/shared_force.h"

namespace phrenic {

class Gravity final : public SharedForce {
 public:
  // Returns null, and reports it, if the acceleration is 0.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Gravity& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  Eigen::Vector3d Whole(const EvalContext&) const override { return acceleration_; }  // the weights are the masses

 private:
  explicit Gravity(std::string name) : SharedForce(std::move(name)) {}

  Eigen::Vector3d acceleration_;  // [m/s^2]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
