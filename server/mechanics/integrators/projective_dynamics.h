// Projective dynamics, for preview: backward Euler, M (v' - v) = dt f(x + dt v', v'), by a few iterations with a matrix
// that is factorised once and serves every step (Bouaziz et al. 2014). It is a quasi-Newton method (Liu, Bouaziz, Kavan
// 2017) for every force that tells its stiffness: v' += B r, r what is missing to the equation, B by L-BFGS from A^-1
// (PrefactoredSystem). The first way is the old velocities; each is cut back where r along it turns round, so that it
// leads downhill however stiff and nonlinear the forces are, and the last velocities are shortened where they would
// gain energy. Order 1 where the iterations suffice, which they do at small steps; at large ones the error stops at
// what they leave, most for what A makes too stiff: springs across their direction. Stable at any step.
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
  absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;

 private:
  const int iterations_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_PROJECTIVE_DYNAMICS_H_
