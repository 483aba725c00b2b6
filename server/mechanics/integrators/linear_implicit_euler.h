// Backward Euler with one Newton step (Baraff and Witkin 1998): (M + dt C + dt^2 K) v' = M v + dt f(x, 0), then
// x += dt v', with M the masses, C the damping and K the stiffness.
//
// Order 1; stable at any step if the forces are linear. It damps fast vibrations strongly. Links are solved together
// with the forces (solve/implicit_stage.h).
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class LinearImplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "linear-implicit Euler"; }
  int order() const override { return 1; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_
