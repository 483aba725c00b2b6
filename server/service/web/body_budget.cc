#include "server/service/web/body_budget.h"

namespace phrenic::service {

std::size_t BodyBudget::used() const {
  absl::MutexLock lock(&mutex_);
  return used_;
}

bool BodyBudget::Take(const std::string& caller, std::size_t bytes) {
  absl::MutexLock lock(&mutex_);
  const auto known = callers_.find(caller);
  const std::size_t own = known == callers_.end() ? 0 : known->second;
  if (bytes > total_ - used_ || bytes > each_ - own) return false;
  callers_[caller] = own + bytes;
  used_ += bytes;
  return true;
}

void BodyBudget::GiveBack(const std::string& caller, std::size_t bytes) {
  if (bytes == 0) return;
  absl::MutexLock lock(&mutex_);
  used_ -= bytes;
  std::size_t& own = callers_[caller];
  own -= bytes;
  if (own == 0) callers_.erase(caller);
}

}  // namespace phrenic::service
