// Where a scene is stable: limits of the step, a map over stiffness and step, and extreme cases.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_H_
#define PHRENIC_SERVER_STUDY_STABILITY_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// The tables of stability_limits.h, stability_map.h and extremes.h; the request's `stability` has its defaults. No run
// takes more CPU time than most_seconds_a_run, so that the study ends: 100 to 200 runs that count for a map over seven
// stiffnesses and eight integrators, most of which end early. CANCELLED as soon as `progress` says so.
absl::StatusOr<v1::StabilityTable> StudyStability(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_H_
