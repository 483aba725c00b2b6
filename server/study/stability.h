// The stability study: largest stable steps, a map over stiffness and step, and extreme cases.
#ifndef PHRENIC_SERVER_STUDY_STABILITY_H_
#define PHRENIC_SERVER_STUDY_STABILITY_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Fills in the tables of stability_limits.h, stability_map.h and extremes.h. Each run is limited to the CPU time
// most_seconds_a_run; a map over seven stiffnesses and eight integrators has 100 to 200 runs, most of which end early.
// Requires: every field of the request's `stability` is set. CANCELLED if `progress` returns false. Uses one thread.
absl::StatusOr<v1::StabilityTable> StudyStability(const v1::CreateStudyRequest& request, const Subject& subject,
                                                  const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_STABILITY_H_
