#include "server/access/rate.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMaxCallers = 10'000;
constexpr double kBurst = 2;  // [s]

}  // namespace

absl::Status RateLimit::Take(const std::string& caller, absl::Time now) {
  if (rate_ <= 0) return absl::OkStatus();
  absl::MutexLock lock(&mutex_);
  const double capacity = kBurst * rate_;
  const auto known = by_caller_.find(caller);
  if (known == by_caller_.end()) {
    buckets_.push_front({caller, capacity, now});
    by_caller_[caller] = buckets_.begin();
    if (buckets_.size() > kMaxCallers) {
      by_caller_.erase(buckets_.back().caller);
      buckets_.pop_back();
    }
  } else {
    buckets_.splice(buckets_.begin(), buckets_, known->second);
  }
  Bucket& bucket = buckets_.front();
  bucket.tokens =
      std::min(capacity, bucket.tokens + rate_ * std::max(0.0, absl::ToDoubleSeconds(now - bucket.updated)));
  bucket.updated = now;
  if (bucket.tokens < 1) {
    return absl::ResourceExhaustedError(
        absl::StrCat("more than ", rate_, " requests per second (--max-requests); send fewer requests"));
  }
  bucket.tokens -= 1;
  return absl::OkStatus();
}

}  // namespace phrenic::access
