// Time and waiting, passed in so that tests can make both.
#ifndef PHRENIC_SERVER_STREAM_CLOCK_H_
#define PHRENIC_SERVER_STREAM_CLOCK_H_

#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace phrenic::stream {

// Any thread may call.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual absl::Time Now() const = 0;
  // Returns when `condition` holds or `deadline` has come; `mutex` is held before and after, as in absl::Mutex::Await.
  virtual void Await(absl::Mutex& mutex, const absl::Condition& condition, absl::Time deadline) const = 0;
};

class SystemClock final : public Clock {
 public:
  absl::Time Now() const override { return absl::Now(); }
  void Await(absl::Mutex& mutex, const absl::Condition& condition, absl::Time deadline) const override {
    mutex.AwaitWithDeadline(condition, deadline);
  }
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CLOCK_H_
