// The largest stable step: predicted from the fastest vibration, and measured.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_
#define PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_

#include "phrenic/v1/study_results.pb.h"
#include "server/mechanics/stability/spectrum.h"
#include "server/study/context.h"

namespace phrenic::study {

inline constexpr double kLongestStep = 0.1;  // that a session takes [s]

// The subject with all springs and elements `factor` times as stiff as its parameters say. (Beyond what a session may
// ask for: every force with a stiffness of its tissue takes elasticity as a factor.)
Subject Stiffened(const Subject& subject, double factor);

// Fastest vibration of the model at rest under the subject's parameters.
FastestMode ModeOf(const Subject& subject);
// The largest stable step of the subject's integrator by theory [s], without a safety factor; infinity where nothing
// limits it, 0 where no step is stable.
double TheoreticalStep(const Subject& subject, const FastestMode& fastest);

// The initial state, with velocities along the fastest mode, so small that nothing else changes: what is unstable grows
// from it.
State Kicked(const Subject& subject, const FastestMode& fastest);

// Fills in the row: bisects the step on whether the distance of a kicked run from one that was not grows; what is
// measured is right within 1 %. Growth: the largest kinetic energy of the difference in the last quarter of 400 steps
// is 30 times that of the second quarter. Explicit Euler's
// growth is slow: twice as much in 60/(friction rate x dt) steps, and nothing is measured where that is more than
// 20,000. Breath and muscles are off, since tissue that buckles under them grows apart at any step. CANCELLED as soon
// as `progress` says so.
absl::Status MeasureLimit(const Subject& subject, double most_cpu_s, const Progress& progress, v1::LimitRow& row);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_LIMITS_H_
