// A step in as many parts as its error asks for.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_
#define PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_

#include "absl/status/status.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Carries `state` over dt by `integrator`, each part taken once whole and once in halves: where the two differ
// by more than `tolerance` (2^order - 1) [m] at some vertex, in position or in velocity times the part, the part is
// halved, down to dt/4096; the halves are kept. The size of parts is remembered in State::halvings. ABORTED where the
// smallest part still errs more.
absl::Status AdvanceAdaptively(const Model& model, const v1::Parameters& parameters, const Integrator& integrator,
                               double dt, State& state, Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_
