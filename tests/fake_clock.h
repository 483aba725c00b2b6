// A clock that the test advances.
#ifndef PHRENIC_TESTS_FAKE_CLOCK_H_
#define PHRENIC_TESTS_FAKE_CLOCK_H_

#include "absl/base/thread_annotations.h"
#include "server/schema/clock.h"

namespace phrenic {

// Starts at a fixed time. Thread-safe.
class FakeClock final : public Clock {
 public:
  absl::Time Now() const override {
    absl::MutexLock lock(&mutex_);
    return now_;
  }
  void Await(absl::Mutex& mutex, const absl::Condition& condition, absl::Time deadline) const override {
    if (deadline == absl::InfiniteFuture()) return mutex.Await(condition);
    while (!condition.Eval() && Now() < deadline) mutex.AwaitWithTimeout(condition, absl::Milliseconds(1));
  }
  // Moves the time forward; Await returns within a few milliseconds of real time.
  void Advance(absl::Duration duration) {
    absl::MutexLock lock(&mutex_);
    now_ += duration;
  }

 private:
  mutable absl::Mutex mutex_;
  absl::Time now_ ABSL_GUARDED_BY(mutex_) = absl::FromUnixSeconds(1'700'000'000);
};

// Polls `condition`. Returns true as soon as it holds, false after ten seconds of real time.
template <class Condition>
bool Eventually(const Condition& condition) {
  const absl::Time last = absl::Now() + absl::Seconds(10);
  while (!condition()) {
    if (absl::Now() > last) return false;
    absl::SleepFor(absl::Milliseconds(1));
  }
  return true;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_FAKE_CLOCK_H_
