// Runs the suite of extreme cases and judges each result.
#ifndef PHRENIC_SERVER_STUDY_EXTREMES_H_
#define PHRENIC_SERVER_STUDY_EXTREMES_H_

#include <map>
#include <string>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"
#include "server/study/extreme_cases.h"

namespace phrenic::study {

// Errors of the baseline case by name of the run ("bdf2, guarded"): RMS error over the largest displacement [1].
using Baselines = std::map<std::string, double>;
// Measures them. INTERNAL if the baseline has no reference solution; CANCELLED if `progress` returns false.
absl::StatusOr<Baselines> BaselineErrors(const v1::StabilityStudy& study, const Progress& progress);

// Appends two rows per integrator, without and with error control (step_tolerance of 1 um, "guarded"), or a single row
// if the scene is refused. A run passes if it stays finite, its kinetic energy is at most 1.1 times its sources
// (energy_balance.h), and its RMS error is at most 5 % of the largest displacement or twice the baseline's error. It is
// "stopped" if it ends with an error that names time, vertex, force and remedy; else "FAILED". Integrators: those of
// the study, or semi-implicit Euler, velocity Verlet, Runge-Kutta 4, linear-implicit Euler and BDF2.
absl::Status AddExtreme(const ExtremeCase& extreme, const Baselines& baselines, const v1::StabilityStudy& study,
                        const Progress& progress, v1::StabilityTable& table);

// Appends the rows of all cases, which do not depend on the study's scene. CANCELLED if `progress` returns false.
absl::Status AddExtremes(const v1::StabilityStudy& study, const Progress& progress, v1::StabilityTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_EXTREMES_H_
