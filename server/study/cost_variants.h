// The rows of the cost study: the scene whole, without each of its parts, and with each part left out or switched off.
#ifndef PHRENIC_SERVER_STUDY_COST_VARIANTS_H_
#define PHRENIC_SERVER_STUDY_COST_VARIANTS_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Another scene under the subject's parameters.
absl::StatusOr<Subject> Recompile(const v1::CreateStudyRequest& request, const Subject& subject, const v1::Scene& scene,
                                  const Compiler& compile);

// Appends to the table's rows. "full, once more" is the same scene compiled anew: what its row is off 1 by is the
// measurement's own blur. A row "X left out" is held against the row "without X", both of one round of trials.
absl::Status AddVariants(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                         const Progress& progress, v1::CostTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_VARIANTS_H_
