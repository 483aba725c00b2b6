// The largest stable time step: predicted from the spectrum, and measured by bisection.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_
#define PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_

#include "phrenic/v1/study_results.pb.h"
#include "server/mechanics/stability/spectrum.h"
#include "server/study/context.h"

namespace phrenic::study {

inline constexpr double kLongestStep = 0.1;  // largest time step that a session accepts [s]

// Returns the subject with its elasticity, the factor of all springs and elements, multiplied by `factor`. The result
// may exceed the range that a session accepts.
Subject Stiffened(const Subject& subject, double factor);

// Returns the fastest mode of the model at rest under the subject's parameters.
FastestMode ModeOf(const Subject& subject);
// Returns the largest stable step of the subject's integrator by linear theory [s], without a safety factor; infinity
// if there is no limit, 0 if no step is stable.
double TheoreticalStep(const Subject& subject, const FastestMode& fastest);

// Returns the initial state with a small velocity along the fastest mode, from which an instability grows: the
// amplitude is 1e-8 of the scene's size.
State Perturbed(const Subject& subject, const FastestMode& fastest);

// Measures the largest stable step to 1 % and fills in the row with it, the prediction and their ratio. Bisects on
// whether the perturbed run leaves the same run at a tenth of the predicted step (leaving.h) within `seconds`, at least
// 400 and at most 20,000 steps, with breath and muscles as in the scene. Explicit Euler, which grows slowly, gets
// 60/(friction rate x dt) steps. What collapses or buckles at a tenth of the step too is physics and not counted; if
// the run at a tenth fails, nothing is measured. If there is no number, the row's note says why. A run takes at most
// `most_cpu_s` [s] of CPU time. CANCELLED if `progress` returns false.
absl::Status MeasureLimit(const Subject& subject, double seconds, double most_cpu_s, const Progress& progress,
                          v1::LimitRow& row);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_
