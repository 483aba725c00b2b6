// The thesis' solver as printed (appendix A.1.3): v += dt f/m, then v -= 0.02 v/m without dt, then x += dt v.
//
// The damping is per step, so its rate is 0.02/(m dt): 0.2 /s at dt 0.1 s and 20 /s at 1 ms for 1 kg. The method does
// therefore not converge with the step (order 0), and diverges at any step if a vertex on springs is lighter than 0.02
// kg. It reproduces the thesis' results for comparison, together with PROJECTION_THESIS for links.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_THESIS_EULER_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_THESIS_EULER_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class ThesisEuler final : public Integrator {
 public:
  std::string_view name() const override { return "thesis (A.1.3)"; }
  int order() const override { return 0; }
  double MaxStep(const Spectrum& spectrum) const override;
  Damping counted_damping() const override { return Damping::kAll; }
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_THESIS_EULER_H_
