// Which inputs of a scene its outputs depend on.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_SENSITIVITY_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_SENSITIVITY_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Screens the inputs by Morris' method, keeps those with the largest effects on any output, and computes Sobol indices
// over these by polynomial chaos, by Saltelli's sampling or by both; the other inputs then have the subject's values.
// Requires: the defaults of the study are set. Errors: those of MakeInputs, Outputs::Make and RunAll; INVALID_ARGUMENT
// if no method is asked for, or for more than kMostRuns runs or kMostTerms coefficients.
absl::StatusOr<v1::SensitivityTable> StudySensitivity(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Progress& progress);

inline constexpr double kMostTerms = 2000;  // of the polynomials of an output

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_SENSITIVITY_H_
