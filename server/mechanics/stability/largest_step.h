// The largest stable step of a model.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_LARGEST_STEP_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_LARGEST_STEP_H_

#include "server/mechanics/model.h"

namespace phrenic {

// The longest step that is chosen automatically: one step per frame [s].
inline constexpr double kLongestStep = 1.0 / 60;

// Returns the largest stable step at rest under these parameters [s], with 5 % safety below the estimate from the
// fastest mode (FindFastestMode), and the reason. Thread-safe.
v1::StableStep LargestStableStep(const Model& model, const v1::Parameters& parameters);

// True if the largest stable steps of two sets of parameters are the same: elasticity and integrator are.
bool HaveSameStableStep(const v1::Parameters& a, const v1::Parameters& b);

// Returns the largest stable step, without computing it if it is that of the scene's own parameters. So a session, a
// study and a batch with the same parameters take the same steps. Thread-safe.
v1::StableStep StableStepOf(const Model& model, const v1::Parameters& parameters);

// Returns the step of a run for which none is set: 0.9 of the largest stable one, rounded down to two digits, at most
// kLongestStep [s].
double ChosenStep(const v1::StableStep& stable);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_LARGEST_STEP_H_
