// The error study: a work-precision diagram of every integrator.
#ifndef PHRENIC_SERVER_STUDY_ERROR_H_
#define PHRENIC_SERVER_STUDY_ERROR_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the scene with every requested integrator and a sequence of time steps: the largest stable step (1/30 s without
// a stability limit), halved repeatedly; each step divides the time between moments. After a run exceeds its CPU time,
// smaller steps are not tried. Errors are those of positions at the moments against ConfirmedReference of the same
// scene with exact link projection and all springs in double precision: the thesis' projection is not smooth, and an
// adaptive solver resolves round-off of single precision as motion. A row whose error is below three times the error of
// the reference gets the verdict "below the reference's error" and no number. The table also has the residual of links
// over time for each projection, and the error at probes against mesh resolution. Requires: every field of the
// request's study is set. Errors: those of ConfirmedReference and of the compile step. Uses one thread.
absl::StatusOr<v1::ErrorTable> StudyError(const v1::CreateStudyRequest& request, const Subject& subject,
                                          const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ERROR_H_
