// Velocity Verlet: v += dt/2 a, x += dt v, then v += dt/2 a at the new positions; with rigid links RATTLE (Andersen
// 1983): positions are projected after the drift and velocities after the second kick.
//
// Order 2, symplectic; stable for dt < 2/omega_max [rad/s] at any friction: half of it is applied explicitly at the
// start and half implicitly at the end. Viscosity (Force::AddViscosity) acts with the velocities of half a step before:
// it is of order 1 and limits the step as in semi-implicit Euler. One evaluation of the forces per step: State::history
// keeps that at the end.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_VELOCITY_VERLET_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_VELOCITY_VERLET_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class VelocityVerlet final : public Integrator {
 public:
  std::string_view name() const override { return "velocity Verlet"; }
  int order() const override { return 2; }
  double MaxStep(const Spectrum& spectrum) const override;
  Damping counted_damping() const override { return Damping::kViscosity; }
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_VELOCITY_VERLET_H_
