// One study, whatever its kind.
#ifndef PHRENIC_SERVER_STUDY_RUN_H_
#define PHRENIC_SERVER_STUDY_RUN_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Gives the study its defaults, compiles the scene and runs it, as long as `progress` says so. INVALID_ARGUMENT where
// the request names no kind of study; else the errors of the compile step and of the kind.
absl::StatusOr<v1::StudyResult> Run(v1::CreateStudyRequest request, const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_RUN_H_
