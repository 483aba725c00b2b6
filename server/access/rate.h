// How many requests a caller may make: so many a second, and twice as many at once.
#ifndef PHRENIC_SERVER_ACCESS_RATE_H_
#define PHRENIC_SERVER_ACCESS_RATE_H_

#include <list>
#include <map>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"

namespace phrenic::access {

// A bucket a caller that fills as time goes by (a token bucket). Any thread may call.
class RateLimit {
 public:
  // 0: any number.
  explicit RateLimit(double a_second) : a_second_(a_second) {}

  // RESOURCE_EXHAUSTED names the limit. `now` of one clock.
  absl::Status Take(const std::string& caller, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Bucket {
    std::string caller;
    double left;
    absl::Time at;
  };

  const double a_second_;
  absl::Mutex mutex_;
  std::list<Bucket> buckets_ ABSL_GUARDED_BY(mutex_);  // the last caller first; the longest silent ones go
  std::map<std::string, std::list<Bucket>::iterator> places_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_RATE_H_
