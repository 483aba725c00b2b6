// How far the outputs of a scene scatter if its inputs do.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_UNCERTAINTY_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_UNCERTAINTY_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the scene at points of Sobol's sequence, and once with the subject's values; percentiles of each output, and of
// each measure in the course of the measured time. Requires: the defaults of the study are set. Errors: those of
// MakeInputs, Outputs::Make and RunAll.
absl::StatusOr<v1::UncertaintyTable> StudyUncertainty(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_UNCERTAINTY_H_
