// Runs one study of any kind.
#ifndef PHRENIC_SERVER_STUDY_QUEUE_RUN_H_
#define PHRENIC_SERVER_STUDY_QUEUE_RUN_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// What is wrong with a request that names no kind of study.
inline constexpr char kNoStudy[] =
    "what: must be set: error, stability, cost, streaming, sensitivity, uncertainty or convergence";

// Fills in the defaults of the study, compiles the scene and runs the study. The result has the table of its kind, the
// scene's name and hash, the parameters and the wall time. Errors: INVALID_ARGUMENT if the request names no kind of
// study; those of the compile step and of the kind; CANCELLED if `progress` returns false.
absl::StatusOr<v1::StudyResult> Run(v1::CreateStudyRequest request, const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_QUEUE_RUN_H_
