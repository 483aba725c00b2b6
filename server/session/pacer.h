// How simulated time follows wall-clock time, and when a frame is due.
#ifndef PHRENIC_SERVER_SESSION_PACER_H_
#define PHRENIC_SERVER_SESSION_PACER_H_

#include "absl/time/time.h"

namespace phrenic::session {

// On the wall clock: a session offers a frame, and ends a burst of steps, this often.
inline constexpr double kFramesPerSecond = 60;

// Simulated time t = t0 + speed (now - w0). A machine that is too slow catches up with a tenth of a second of
// wall-clock time at most; the rest is lost, and the session runs slower than requested. Not thread-safe. SteppingLoop
// owns it and passes the time, so that tests need no clock. Frames are due on the wall clock, at any speed.
class Pacer {
 public:
  // Starts at simulated time `time` [s] with `speed` simulated seconds per second; 0 is as fast as possible. The first
  // frame is due a sixtieth of a second later.
  void Start(absl::Time now, double time, double speed);
  // Returns the simulated time to reach at `now` for a session at `time` [s]; infinity if as fast as possible. Moves t0
  // and w0 if the session is too slow or the clock was set back.
  double Target(absl::Time now, double time);
  double speed() const { return speed_; }

  bool FrameDue(absl::Time now) const { return now >= next_frame_; }
  absl::Time next_frame() const { return next_frame_; }
  // Notes a frame made at `now`: the next is due a sixtieth of a second after this one was due, `now` at the earliest.
  void FrameMade(absl::Time now);

 private:
  absl::Time start_;       // w0
  double start_time_ = 0;  // [s]
  double speed_ = 1;
  absl::Time next_frame_ = absl::InfinitePast();
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PACER_H_
