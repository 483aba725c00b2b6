// One step of a run.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_H_

#include "absl/status/status.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Advances the state by dt [s], with the integrator that the parameters name; in parts if they set a step_tolerance.
// Allocates nothing but in the first step of an integrator. One thread per state and workspace.
//
// OUT_OF_RANGE if the step diverged: a position is not finite or beyond Model::bound, or a velocity is not finite or
// would cross that distance within the step. The state is then invalid: Diagnose (stability/diagnosis.h) names the
// cause, and StepCheckpoint (step_checkpoint.h) recomputes the state before. ABORTED if the integrator found no next
// state.
absl::Status Step(const Model& model, const v1::Parameters& parameters, double dt, State& state, Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_H_
