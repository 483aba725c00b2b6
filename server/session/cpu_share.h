// How much of a processor core a session's stepping may have.
#ifndef PHRENIC_SERVER_SESSION_CPU_SHARE_H_
#define PHRENIC_SERVER_SESSION_CPU_SHARE_H_

#include "absl/time/time.h"

namespace phrenic::session {

// Work that began at t0 and took the processor for c seconds earns a rest until max(t0, the last rest's end) + c /
// share: over any longer time the thread has had no more than its share. Not thread-safe.
class CpuShare {
 public:
  // `share` of a core, above 0; 1 or more is no limit.
  explicit CpuShare(double share) : share_(share) {}

  // Work begins: `cpu` is what the thread has had of the processor so far.
  void Begin(absl::Time now, absl::Duration cpu);
  void End(absl::Duration cpu);
  // Until then no work is to begin; at once where the clock was set back.
  absl::Time RestsUntil(absl::Time now) const { return now < began_ ? absl::InfinitePast() : rests_until_; }

 private:
  const double share_;
  absl::Time began_ = absl::InfinitePast();
  absl::Duration cpu_;
  absl::Time rests_until_ = absl::InfinitePast();
};

// What the calling thread has had of the processor so far.
absl::Duration ThreadCpu();

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CPU_SHARE_H_
