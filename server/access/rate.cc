#include "server/access/rate.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMostCallers = 10'000;
constexpr double kBurst = 2;  // [s]

}  // namespace

absl::Status RateLimit::Take(const std::string& caller, absl::Time now) {
  if (a_second_ <= 0) return absl::OkStatus();
  absl::MutexLock lock(&mutex_);
  const double full = kBurst * a_second_;
  const auto place = places_.find(caller);
  if (place == places_.end()) {
    buckets_.push_front({caller, full, now});
    places_[caller] = buckets_.begin();
    if (buckets_.size() > kMostCallers) {
      places_.erase(buckets_.back().caller);
      buckets_.pop_back();
    }
  } else {
    buckets_.splice(buckets_.begin(), buckets_, place->second);
  }
  Bucket& bucket = buckets_.front();
  bucket.left = std::min(full, bucket.left + a_second_ * std::max(0.0, absl::ToDoubleSeconds(now - bucket.at)));
  bucket.at = now;
  if (bucket.left < 1) {
    return absl::ResourceExhaustedError(
        absl::StrCat("more than ", a_second_, " requests a second (--max-requests); ask less often"));
  }
  bucket.left -= 1;
  return absl::OkStatus();
}

}  // namespace phrenic::access
