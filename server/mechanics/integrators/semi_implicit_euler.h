// Semi-implicit Euler (thesis equations 2.6-2.7): v += dt f/m, then x += dt v. Order 1, symplectic.
//
// Stable for omega^2 dt^2 + 2 c dt < 4, omega the largest frequency [rad/s], c its damping rate [1/s] (from the
// characteristic polynomial of x'' = -omega^2 x - c x'). Damping S that vertices share (flow out of a chamber) is
// applied implicitly, (M + dt S)(v' - v) = dt f, and does not limit the step.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_SEMI_IMPLICIT_EULER_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_SEMI_IMPLICIT_EULER_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class SemiImplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "semi-implicit Euler"; }
  int order() const override { return 1; }
  bool needs_start() const override { return false; }
  double MaxStep(const Spectrum& spectrum) const override;
  Damping counted_damping() const override { return Damping::kOfEachVertex; }
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_SEMI_IMPLICIT_EULER_H_
