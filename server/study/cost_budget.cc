#include "server/study/cost_budget.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"

namespace phrenic::study {

double CostBudget::LeftUntil(double fraction) const { return std::max(0.0, fraction * seconds_ - spent()); }

void CostBudget::Cut(const std::string& what, double takes) {
  notes_.push_back(
      absl::StrFormat("%s: it takes about %.0f s, and the study has %.0f s in all (most_seconds); set "
                      "most_seconds to about %.0f",
                      what, std::ceil(takes), seconds_, std::ceil(seconds_ + takes)));
}

}  // namespace phrenic::study
