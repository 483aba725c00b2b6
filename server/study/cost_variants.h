// Rows of the cost study: the full scene, and the scene with each part removed, made empty or switched off.
#ifndef PHRENIC_SERVER_STUDY_COST_VARIANTS_H_
#define PHRENIC_SERVER_STUDY_COST_VARIANTS_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"
#include "server/study/cost_budget.h"

namespace phrenic::study {

// Appends the rows. "full, repeated" is the same scene compiled again: the deviation of its ratio from 1 is the noise
// of the measurement. A row "X left out" is compared with the row "without X" of the same trials: a ratio of 1 shows
// that a part without effect costs nothing. Errors: those of the compile step; CANCELLED if `progress` returns false.
absl::Status AddVariants(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                         CostBudget& budget, const Progress& progress, v1::CostTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_VARIANTS_H_
