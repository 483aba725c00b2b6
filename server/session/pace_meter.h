// Measures how fast a session steps.
#ifndef PHRENIC_SERVER_SESSION_PACE_METER_H_
#define PHRENIC_SERVER_SESSION_PACE_METER_H_

#include <cstdint>

#include "absl/time/time.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::session {

// Steps, simulated time and CPU time over windows of about a second. Not thread-safe: the stepping thread owns it,
// whose CPU time it reads.
class PaceMeter {
 public:
  // Begins a window at simulated time `time` [s].
  void Start(absl::Time now, std::int64_t tick, double time);
  // Returns true if a window has just ended, so that pace() is new. `last` ends the window however short it is.
  bool Update(absl::Time now, std::int64_t tick, double time, bool last = false);
  const v1::Pace& pace() const { return pace_; }

 private:
  absl::Time start_;
  std::int64_t start_tick_ = 0;
  double start_time_ = 0;  // simulated [s]
  double start_cpu_ = 0;   // [s]
  v1::Pace pace_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PACE_METER_H_
