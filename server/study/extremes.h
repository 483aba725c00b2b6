// The suite of extreme cases, judged.
#ifndef PHRENIC_SERVER_STUDY_EXTREMES_H_
#define PHRENIC_SERVER_STUDY_EXTREMES_H_

#include <map>
#include <string>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"
#include "server/study/extreme_cases.h"

namespace phrenic::study {

// What each kind of run errs by where nothing is extreme: its mean error over the largest way of any vertex.
using Baselines = std::map<std::string, double>;
absl::StatusOr<Baselines> BaselineErrors(const v1::StabilityStudy& study, const Progress& progress);

// Appends a row for each integrator, unguarded and with a step_tolerance of 1 um; one row where the scene is refused.
// Integrators: the study's, or semi-implicit Euler, velocity Verlet, Runge-Kutta 4, linear-implicit Euler and BDF2.
absl::Status AddExtreme(const ExtremeCase& extreme, const Baselines& baselines, const v1::StabilityStudy& study,
                        const Progress& progress, v1::StabilityTable& table);

// All cases. They do not depend on the study's scene. CANCELLED as soon as `progress` says so.
absl::Status AddExtremes(const v1::StabilityStudy& study, const Progress& progress, v1::StabilityTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_EXTREMES_H_
