#include "tests/bench/streaming/seen.h"

#include <algorithm>
#include <utility>

#include "absl/time/clock.h"

namespace phrenic::bench {

double Sight::Age(double part) const {
  if (ages.empty()) return 0;
  return ages[static_cast<std::size_t>(part * static_cast<double>(ages.size() - 1))];
}

void Seen::Add(const v1::Frame& frame, std::int64_t bytes, std::int64_t last) {
  const double age = absl::ToDoubleSeconds(absl::Now() - absl::FromUnixNanos(frame.unix_nanos()));
  absl::MutexLock lock(&mutex_);
  sight_.ages.push_back(age);
  ++sight_.frames;
  sight_.bytes += bytes;
  if (last > 0) sight_.gaps += frame.sequence() - last - 1;
  sight_.largest_error = std::max(sight_.largest_error, frame.max_error_mm());
}

Sight Seen::Take() {
  Sight sight;
  {
    absl::MutexLock lock(&mutex_);
    sight = std::exchange(sight_, {});
  }
  std::sort(sight.ages.begin(), sight.ages.end());
  return sight;
}

}  // namespace phrenic::bench
