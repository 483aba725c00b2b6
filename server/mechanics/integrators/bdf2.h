// The second backward differentiation formula: x' = (4 x - x_before + 2 dt v')/3, and v' in the same way from
// a = f(x', v')/m, by Newton's method.
//
// Order 2, with links too, which are solved within the step (solve/implicit_stage.h); stable at any step if the forces
// are linear; damps fast vibrations. State::history keeps the step before. If that is missing or had another length, or
// a length limit was reached or released in it, the step is one of TR-BDF2.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_BDF2_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_BDF2_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class Bdf2 final : public Integrator {
 public:
  std::string_view name() const override { return "BDF2"; }
  int order() const override { return 2; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_BDF2_H_
