// Which steps are stable at which stiffness.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_MAP_H_
#define PHRENIC_SERVER_STUDY_STABILITY_MAP_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Stiffness over the scene's own: 1, 10, ... up to `stiffest`.
std::vector<double> StiffnessFactors(double stiffest);

// Appends the rows of every integrator at every stiffness: the scene itself, from a kick too small to see, over the
// study's time. Time steps go by factors of two from the theoretical limit (0.95 and 1.05 times it) down and up; from
// 0.1 s down where theory sets none. The longest goes first; once a run of an integrator is out of time, those that
// take as many steps or more are not tried. CANCELLED as soon as `progress` says so.
absl::Status AddMap(const Subject& subject, const v1::StabilityStudy& study, const Progress& progress,
                    v1::StabilityTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_MAP_H_
