#include "server/study/cost.h"

#include "server/study/cost_budget.h"
#include "server/study/cost_sizes.h"
#include "server/study/cost_stages.h"
#include "server/study/cost_variants.h"

namespace phrenic::study {
namespace {

// Fractions of the study's progress at which its parts end.
constexpr double kVariantsEnd = 0.5, kStagesEnd = 0.55, kSizesEnd = 0.8;

}  // namespace

absl::StatusOr<v1::CostTable> StudyCost(const v1::CreateStudyRequest& request, const Subject& subject,
                                        const Compiler& compile, const Progress& progress) {
  v1::CostTable table;
  CostBudget budget(request.cost().most_seconds());
  absl::Status status = AddVariants(request, subject, compile, budget, Part(progress, 0, kVariantsEnd), table);
  if (!status.ok()) return status;
  status = AddStages(subject, request.cost().steps(), Part(progress, kVariantsEnd, kStagesEnd), table);
  if (!status.ok()) return status;
  if (!request.cost().leave_out_sizes()) {
    status = AddSizes(request, subject, compile, budget, Part(progress, kStagesEnd, kSizesEnd), table);
    if (!status.ok()) return status;
  }
  status = AddGrowth(request, subject, compile, budget, Part(progress, kSizesEnd, 1), table);
  if (!status.ok()) return status;
  table.mutable_notes()->Assign(budget.notes().begin(), budget.notes().end());
  return table;
}

}  // namespace phrenic::study
