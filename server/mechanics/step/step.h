// One step of a run, and what can go wrong in it.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_H_

#include "absl/status/status.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic {

// The state becomes the state at t + dt, by the integrator that the parameters name. OUT_OF_RANGE when the
// step diverged (a position that is not finite, or ten times the scene's size outside its box at rest; velocities that
// are not finite, or that would cross all that in one step); `state` is then
// not to be shown to anyone, and Diagnose says why; StepCheckpoint (step_checkpoint.h) finds the state before. ABORTED
// when the integrator found no next state. Allocates nothing.
absl::Status Step(const Model& model, const v1::Parameters& parameters, double dt, State& state, Workspace& work);

// Names the vertex that went furthest in a diverged state, the force with the largest pull on it before, and a remedy.
v1::Divergence Diagnose(const Model& model, const v1::Parameters& parameters, const absl::Status& why,
                        const State& before, const State& diverged);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_H_
