// Lengths within limits, l_min <= |x_b - x_a| <= l_max: cables that do not stretch, struts that do not shorten. What is
// violated is brought back to its limit as a rigid link is (mass-weighted, velocities by the same over dt, momentum and
// angular momentum kept; LinkNetwork), and let go where it would have to push a cable or pull a strut; the residual is
// what is left. Velocities that would lead beyond a limit that is reached are stopped (an inelastic jerk).
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_

#include "server/mechanics/constraints/link_network.h"

namespace phrenic {

class Limits final : public Constraint {
 public:
  // Null where no edge lies in the region.
  static absl::StatusOr<std::unique_ptr<Constraint>> Make(const v1::LengthLimits& scene, const std::string& name,
                                                          std::string_view path, ModelBuilder& builder);

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override;
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const override;
  bool smooth() const override { return false; }
  double Residual(const State& state) const override;

 private:
  explicit Limits(std::string name) : Constraint(std::move(name)) {}

  LinkNetwork network_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_
