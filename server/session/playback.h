// How fast and how far a playing session steps.
#ifndef PHRENIC_SERVER_SESSION_PLAYBACK_H_
#define PHRENIC_SERVER_SESSION_PLAYBACK_H_

#include <atomic>
#include <memory>
#include <optional>

#include "phrenic/v1/saved.pb.h"

namespace phrenic::session {

// The simulated time of a playing session [s], for sessions that play in step with it; infinity while it is not
// playing, so that followers never wait. Any thread may read it. The session's SteppingLoop writes it.
using ReachedTime = std::atomic<double>;

// What PlaySession asks for.
struct PlayRequest {
  std::optional<double> speed = std::nullopt;  // simulated seconds per second; nullopt keeps the present speed; above 0
  bool as_fast_as_possible = false;
  double until = 0;                              // simulated time at which the session pauses [s]; 0 never pauses
  std::weak_ptr<const ReachedTime> leader = {};  // of the session that this one plays in step with
  bool keep_playing = false;                     // without viewers
};

// The speed, the end and the leader of a playing session. Not thread-safe: the stepping thread owns it.
class Playback {
 public:
  // Requires: the request is in range. Replaces end, leader and `keep_playing`.
  void Start(PlayRequest request);
  // Forgets the end time, and that the session plays on without viewers.
  void Stop() {
    until_ = 0;
    keep_playing_ = false;
  }
  // True if the session plays on without viewers: it was asked to, or has an end.
  bool keeps_playing() const { return keep_playing_ || until_ > 0; }

  double speed() const { return speed_; }  // simulated seconds per second, also while as fast as possible
  bool as_fast_as_possible() const { return as_fast_as_possible_; }
  // Returns the speed that clients see: 0 means as fast as possible.
  double shown_speed() const { return as_fast_as_possible_ ? 0 : speed_; }
  // True if `time` [s] has reached the end.
  bool EndsAt(double time) const;
  // Returns the time up to which the session at `time` need not wait for its leader [s]: a frame ahead of it; infinity
  // without a leader, or if the leader is too far behind to wait for. A frame is speed / kFramesPerSecond [s], with
  // speed 1 while as fast as possible; too far is more than 2 s, and more than two frames. Reads the leader's time
  // without a lock.
  double FurthestInStep(double time) const;

  // The leader is not saved: a restored session plays on its own.
  void Save(v1::SavedMoment& moment) const;
  void Restore(const v1::SavedMoment& moment);

 private:
  double speed_ = 1;
  bool as_fast_as_possible_ = false;
  double until_ = 0;  // [s]
  bool keep_playing_ = false;
  std::weak_ptr<const ReachedTime> leader_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PLAYBACK_H_
