// The classical Runge-Kutta method: four evaluations of the forces at 0, dt/2, dt/2 and dt, weights 1/6, 1/3, 1/3, 1/6.
// Motions are evaluated at each stage.
//
// Order 4, with rigid links too: each stage has their forces, and what that leaves of their lengths at the end of the
// step is projected. Stable up to dt = 2.78/|lambda|,
// lambda the fastest eigenvalue of the motion [1/s]. Not symplectic: it loses energy slowly.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class Rk4 final : public Integrator {
 public:
  std::string_view name() const override { return "Runge-Kutta 4"; }
  int order() const override { return 4; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_
