// How simulated time follows the clock on the wall, and when a frame is due.
#ifndef PHRENIC_SERVER_SESSION_PACER_H_
#define PHRENIC_SERVER_SESSION_PACER_H_

#include "absl/time/time.h"

namespace phrenic::session {

inline constexpr double kFramesPerSecond = 60;

// Simulated time t = t0 + speed (now - w0). Where the machine is too slow, at most a tenth of a second on the wall is
// caught up with; the rest is given up, and the session runs slower than asked for. Not thread-safe.
class Pacer {
 public:
  // From now on, at simulated time `time` [s], `speed` simulated seconds per second; 0 is as fast as possible.
  void Start(absl::Time now, double time, double speed);
  // The simulated time that should be reached now [s]; infinity where it is as fast as possible.
  double Target(absl::Time now, double time);
  double speed() const { return speed_; }

  bool FrameDue(absl::Time now) const { return now >= next_frame_; }
  absl::Time next_frame() const { return next_frame_; }
  // A frame was made: the next is due a sixtieth of a second after this one was.
  void FrameMade(absl::Time now);

 private:
  absl::Time start_;
  double start_time_ = 0;
  double speed_ = 1;
  absl::Time next_frame_ = absl::InfinitePast();
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PACER_H_
