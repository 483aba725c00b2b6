// Projective dynamics, for preview: backward Euler, M (v' - v) = dt f(x + dt v', v'), by a few iterations with a matrix
// that is factorised once for all steps (Bouaziz et al. 2014).
//
// A quasi-Newton method (Liu, Bouaziz, Kavan 2017) for every force with a stiffness: v' += B r, r the residual of the
// equation, B by L-BFGS from A^-1 (PrefactoredSystem). The first direction is the old velocities. Each direction is
// shortened if r along it changes its sign, so that it leads downhill for any stiff and nonlinear force, and the last
// velocities are shortened if they would gain energy. Order 1 at small steps, where the iterations suffice; at large
// steps the remaining residual limits the error, most of all where A is too stiff: for springs across their direction.
// Stable at any step. Links are projected after the step, which may gain energy (README.md).
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_PROJECTIVE_DYNAMICS_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_PROJECTIVE_DYNAMICS_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class ProjectiveDynamics final : public Integrator {
 public:
  explicit ProjectiveDynamics(int iterations = 5) : iterations_(iterations) {}
  std::string_view name() const override { return "projective dynamics"; }
  int order() const override { return 1; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;

 private:
  const int iterations_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_PROJECTIVE_DYNAMICS_H_
