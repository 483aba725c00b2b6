// Limits a session's stepping to a share of a processor core.
#ifndef PHRENIC_SERVER_SESSION_CPU_SHARE_H_
#define PHRENIC_SERVER_SESSION_CPU_SHARE_H_

#include "absl/time/time.h"

namespace phrenic::session {

// After work that began at t0 and used c seconds of CPU time, the thread rests until max(t0, end of the last rest) +
// c / share, so that over any longer time it uses no more than its share. Not thread-safe. SteppingLoop owns it and
// reads the clocks.
class CpuShare {
 public:
  // `share` of a core is above 0; 1 or more is no limit.
  explicit CpuShare(double share) : share_(share) {}

  // Notes that work begins. `cpu` is the thread's CPU time so far (ThreadCpuSeconds). Begin and End alternate.
  void Begin(absl::Time now, absl::Duration cpu);
  // Notes that it ends. `cpu` as for Begin, on the same thread. With a share of 1 or more, no rest follows.
  void End(absl::Duration cpu);
  // Returns the time before which no work may begin; the infinite past if the clock was set back.
  absl::Time RestsUntil(absl::Time now) const { return now < began_ ? absl::InfinitePast() : rests_until_; }

 private:
  const double share_;
  absl::Time began_ = absl::InfinitePast();  // the last Begin
  absl::Duration cpu_;                       // at the last Begin
  absl::Time rests_until_ = absl::InfinitePast();
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CPU_SHARE_H_
