// The classical Runge-Kutta method, bones moving with its stages. Order 4; with rigid links, which are projected at the
// end of the step, order 1. Stable up to dt = 2.78/|lambda|, lambda the fastest eigenvalue of the motion. Not
// symplectic: it loses energy slowly.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class Rk4 final : public Integrator {
 public:
  std::string_view name() const override { return "Runge-Kutta 4"; }
  int order() const override { return 4; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_RK4_H_
