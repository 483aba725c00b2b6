// The thesis' solver to the letter (appendix A.1.3): v += dt f/m, then v -= 0.02 v/m with no dt in it, then x += dt v.
// The damping is per step, so that its rate is 0.02/(m dt): 0.2 /s at dt 0.1 s and 20 /s at 1 ms for 1 kg. It therefore
// does not converge with the step (order 0), and diverges at any step where a vertex on springs is lighter than 0.02
// kg. To reproduce the thesis' results and judge them; links want PROJECTION_THESIS beside it.
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
  absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_THESIS_EULER_H_
