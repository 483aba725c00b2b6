// Wall-clock time and timed waits behind an interface, so that tests control both.
#ifndef PHRENIC_SERVER_SCHEMA_CLOCK_H_
#define PHRENIC_SERVER_SCHEMA_CLOCK_H_

#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"

namespace phrenic {

// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual absl::Time Now() const = 0;
  // Returns when `condition` holds or `deadline` has passed. Requires: the caller holds `mutex`, as for
  // absl::Mutex::Await.
  virtual void Await(absl::Mutex& mutex, const absl::Condition& condition, absl::Time deadline) const = 0;
};

// The machine's clock.
class SystemClock final : public Clock {
 public:
  absl::Time Now() const override { return absl::Now(); }
  void Await(absl::Mutex& mutex, const absl::Condition& condition, absl::Time deadline) const override {
    mutex.AwaitWithDeadline(condition, deadline);
  }
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_CLOCK_H_
