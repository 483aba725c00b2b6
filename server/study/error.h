// Error against run time.
#ifndef PHRENIC_SERVER_STUDY_ERROR_H_
#define PHRENIC_SERVER_STUDY_ERROR_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the scene by every integrator of the request over a ladder of time steps: the largest stable one (a thirtieth of
// a second where nothing limits it), and each half of the one before, all dividing the time between moments; once one
// is out of time, shorter ones are not tried. Errors are those of positions at the moments against ConfirmedReference
// of the same scene with exact links and all springs in double precision: the thesis' projection is not smooth, and a
// solver takes round-off for motion. Rows whose error lies within three times the reference's own are refused ("below
// the reference's error"). Also the links' residual over time for each projection, and the probes' error against mesh
// resolution. Every field of `request`'s study must be set. Errors as of ConfirmedReference.
absl::StatusOr<v1::ErrorTable> StudyError(const v1::CreateStudyRequest& request, const Subject& subject,
                                          const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ERROR_H_
