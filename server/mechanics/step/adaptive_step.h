// A step in as many parts as its error requires.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_
#define PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_

#include "absl/status/status.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {

// Advances `state` by dt [s] with the integrator that the parameters name, except for its time, phase and tick. Each
// part is computed once whole and once in two halves. If the two differ by more than step_tolerance (2^order - 1) [m]
// at some vertex, in position or in velocity times the part, the part is halved, down to dt/4096; otherwise the halves
// are kept. State::halvings keeps the size of parts for the next step. ABORTED if the smallest part differs by more.
absl::Status AdvanceAdaptively(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                               Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_ADAPTIVE_STEP_H_
