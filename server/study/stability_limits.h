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
// whether the difference of a perturbed and an unperturbed run grows: the largest kinetic energy of the difference in
// the last quarter of 400 steps is more than 30 times that in the second quarter. Explicit Euler grows slowly: the
// criterion is a factor of 2 over 60/(friction rate x dt) steps, and nothing is measured above 20,000 steps. Breath and
// muscles are off, because buckling tissue diverges at any step. If there is no number, the row's note says why.
// CANCELLED if `progress` returns false.
absl::Status MeasureLimit(const Subject& subject, double most_cpu_s, const Progress& progress, v1::LimitRow& row);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_
