// Time and waiting, passed in so that tests control both.
#ifndef PHRENIC_SERVER_STREAM_CLOCK_H_
#define PHRENIC_SERVER_STREAM_CLOCK_H_

#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace phrenic::stream {

// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual absl::Time Now() const = 0;
  // Waits until `condition` is true or `deadline` is reached, like absl::Mutex::AwaitWithDeadline. Requires: `mutex` is
  // held.
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
