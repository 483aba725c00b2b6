// Limits the requests of each caller to a rate, with bursts of two seconds' requests.
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

// One token bucket per caller. Keeps the 10,000 most recent callers. Thread-safe. AccessGuard has one for calls and one
// for the refusals that it logs. A caller that was dropped begins with a full bucket again.
class RateLimit {
 public:
  // `rate` [1/s]; 0 means no limit.
  explicit RateLimit(double rate) : rate_(rate) {}

  // Takes one token of the caller's bucket. RESOURCE_EXHAUSTED, with the limit, if it is empty. `now` must come from
  // the same clock in all calls. If the clock goes back, the bucket does not fill meanwhile.
  absl::Status Take(const std::string& caller, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Bucket {
    std::string caller;
    double tokens;       // at most two seconds' requests
    absl::Time updated;  // the last Take
  };

  const double rate_;
  absl::Mutex mutex_;
  std::list<Bucket> buckets_ ABSL_GUARDED_BY(mutex_);  // most recent caller first; the last one is evicted
  std::map<std::string, std::list<Bucket>::iterator> by_caller_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_RATE_H_
