// Explicit Euler: x += dt v, v += dt f/m, both from the start of the step. Order 1.
//
// It adds energy: without friction no step is stable; with friction rate c [1/s] it is stable for dt < c/omega^2 and
// c dt < 2. For comparison only.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_EXPLICIT_EULER_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_EXPLICIT_EULER_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class ExplicitEuler final : public Integrator {
 public:
  std::string_view name() const override { return "explicit Euler"; }
  int order() const override { return 1; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_EXPLICIT_EULER_H_
