// Measures how fast a session steps.
#ifndef PHRENIC_SERVER_SESSION_PACE_METER_H_
#define PHRENIC_SERVER_SESSION_PACE_METER_H_

#include <cstdint>

#include "absl/time/time.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::session {

// Steps, simulated time and CPU time over windows of about a second. Not thread-safe: the stepping thread owns it,
// whose CPU time it reads. pace() is empty before the first window has ended.
class PaceMeter {
 public:
  // Begins a window at simulated time `time` [s]. `now` is wall-clock time. pace() stays.
  void Start(absl::Time now, std::int64_t tick, double time);
  // Returns true if a window has just ended, so that pace() is new. `last` ends the window however short it is. Returns
  // false, and does nothing, while no simulated or wall-clock time has passed in the window. A window that ends begins
  // the next one.
  bool Update(absl::Time now, std::int64_t tick, double time, bool last = false);
  // Steps per wall-clock second, simulated seconds per wall-clock second, and CPU seconds per simulated second.
  const v1::Pace& pace() const { return pace_; }

 private:
  absl::Time start_;  // of the window, on the wall clock
  std::int64_t start_tick_ = 0;
  double start_time_ = 0;  // simulated [s]
  double start_cpu_ = 0;   // [s]
  v1::Pace pace_;          // of the last window
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PACE_METER_H_
