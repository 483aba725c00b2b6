// Backward Euler with one Newton step (Baraff and Witkin 1998): (M + dt C + dt^2 K) v' = M v + dt (f(x) + dt ...), then
// x += dt v'. Order 1, stable at any step for what is linear; it damps fast vibrations strongly.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class LinearImplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "linear-implicit Euler"; }
  int order() const override { return 1; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_LINEAR_IMPLICIT_EULER_H_
