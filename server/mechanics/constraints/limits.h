// Unilateral distance constraints, l_min <= |x_b - x_a| <= l_max [m]: inextensible cables (l_max) and incompressible
// struts (l_min). Violated limits are projected like rigid links (LinkNetwork: mass-weighted, velocities corrected by
// displacement/dt, momentum and angular momentum conserved). A limit is released if its multiplier has the wrong sign,
// that is if it would push a cable or pull a strut. At a limit that is reached, the velocity component that would
// violate it is removed (an inelastic impact). Residual: the largest remaining violation [m].
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_

#include "server/mechanics/constraints/link_network.h"

namespace phrenic {

class Limits final : public Constraint {
 public:
  // Returns null, and reports it, if the region has no edge with a movable end. INVALID_ARGUMENT if the scene sets
  // neither ratio, or the lower above the upper.
  static absl::StatusOr<std::unique_ptr<Constraint>> Make(const v1::LengthLimits& scene, const std::string& name,
                                                          std::string_view path, ModelBuilder& builder);

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override;
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const override;
  bool smooth() const override { return false; }
  bool SameMotion(const ConstPoints& before, const ConstPoints& after) const override;
  void ListLinks(std::vector<Link>& links) const override;
  double Residual(const State& state) const override;

 private:
  explicit Limits(std::string name) : Constraint(std::move(name)) {}

  LinkNetwork network_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LIMITS_H_
