// The static solve: every step ends in equilibrium, f(x) = 0 with v = 0, for bones and muscles at the end of the step.
// Inertia and friction have no effect. All velocities end as 0, also those of vertices that motions drive, so that
// forces of velocity vanish in the state that is read: measures of rates, such as a flow, read 0.
//
// Newton's method with pseudo-transient continuation (Kelley and Keyes 1998): (M/h^2 + K) dx = f, with h growing as
// long as steps stay small, so that the last steps are Newton's. Links are solved together with the forces: their
// multipliers are unknowns of each step. A sequence of such steps is the quasi-static motion;
// the order is 0, since it is not the limit of the dynamic motion for any step.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class StaticEquilibrium final : public Integrator {
 public:
  std::string_view name() const override { return "static"; }
  int order() const override { return 0; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_
