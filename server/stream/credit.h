// Flow control for one viewer: how many frames may be in flight and how coarse they are, from its acknowledgements.
#ifndef PHRENIC_SERVER_STREAM_CREDIT_H_
#define PHRENIC_SERVER_STREAM_CREDIT_H_

#include <cstdint>
#include <deque>

#include "absl/time/time.h"
#include "server/stream/frame_encoding.h"

namespace phrenic::stream {

struct CreditOptions {
  int window = 0;                        // most unacknowledged frames; 0: unlimited
  int bound_level = kDefaultBoundLevel;  // the finest that is used
  bool may_coarsen = false;              // true if the viewer requested no bound
};

// Late acknowledgements mean that frames queue on the connection: the window shrinks. If the frame rate falls too low,
// the error bound grows by a level; it shrinks again when there is capacity. Not thread-safe. Each Viewer has one,
// under its mutex. The window begins at its full size and never falls below 1. It adapts twice a second at most, on
// acknowledgements: one is late if it takes 150 ms more than the quickest so far. The bound grows below 12 frames a
// second, to kCoarsestBoundLevel at most; above 18, or if no frame was missed, a finer one is tried.
class Credit {
 public:
  explicit Credit(const CreditOptions& options)
      : options_(options), allowed_(options.window), bound_level_(options.bound_level) {}

  // True if the window has room.
  bool MaySend() const { return options_.window == 0 || static_cast<int>(unacknowledged_.size()) < allowed_; }
  // `sequence` grows from call to call.
  void Sent(std::int64_t sequence, absl::Time now);
  // Records that a newer frame replaced one before it was sent.
  void Missed(absl::Time now) { missed_ = now; }
  // Acknowledges all frames up to `sequence`. Ignored if none of them is in flight.
  void Acknowledged(std::int64_t sequence, absl::Time now);

  // Frames that may be in flight now; 0: unlimited.
  int allowed() const { return allowed_; }
  // See BoundMillimetres.
  int bound_level() const { return bound_level_; }
  // Returns the number of frames sent in the second before `now`.
  double FramesPerSecond(absl::Time now) const;

 private:
  struct Sending {
    std::int64_t sequence = 0;
    absl::Time at;
  };

  // `delay` is from sending to acknowledgement.
  void Adapt(absl::Duration delay, absl::Time now);
  // Raises the bound by a level, if the options allow it, and doubles the interval until it may be refined, from 5 s to
  // 60 s.
  void Coarsen(absl::Time now);

  const CreditOptions options_;
  int allowed_, bound_level_;
  std::deque<Sending> unacknowledged_;                  // at most the window
  std::deque<absl::Time> recent_;                       // of the last second
  absl::Duration quickest_ = absl::InfiniteDuration();  // acknowledgement so far
  absl::Time missed_ = absl::InfinitePast();            // last frame that was replaced
  absl::Time adapted_ = absl::InfinitePast();           // last adaptation
  absl::Time queued_ = absl::InfinitePast();            // last late acknowledgement
  absl::Time coarsened_ = absl::InfinitePast();         // last change of the bound
  absl::Duration interval_;                             // until the bound may be refined
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CREDIT_H_
