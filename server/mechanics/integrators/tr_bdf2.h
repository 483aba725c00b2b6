// TR-BDF2 (Bank et al. 1985): the trapezoidal rule to t + (2 - sqrt 2) dt, then BDF2 over the three points, each by
// Newton's method.
//
// Order 2, with links too: both stages solve them together with the forces, and the trapezoidal rule begins with their
// forces (solve/link_forces.h). Stable at any step if the forces are linear; damps fast vibrations (L-stable). Needs no
// step before.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_TR_BDF2_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_TR_BDF2_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class TrBdf2 final : public Integrator {
 public:
  std::string_view name() const override { return "TR-BDF2"; }
  int order() const override { return 2; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_TR_BDF2_H_
