// How many frames one viewer may be sent, and how coarse: what its line and its machine take, told by what it
// acknowledges.
#ifndef PHRENIC_SERVER_STREAM_CREDIT_H_
#define PHRENIC_SERVER_STREAM_CREDIT_H_

#include <cstdint>
#include <deque>

#include "absl/time/time.h"
#include "server/stream/frame_encoding.h"

namespace phrenic::stream {

struct CreditOptions {
  int window = 0;  // most frames unacknowledged; 0: nothing is counted
  int rung = kDefaultRung;
  bool may_coarsen = false;  // the viewer named no bound
};

// Frames that come late are queueing: then fewer are on their way. Where few frames a second are left the bound grows
// by a rung, and shrinks again when there is room. Not thread-safe.
class Credit {
 public:
  explicit Credit(const CreditOptions& options) : options_(options), allowed_(options.window), rung_(options.rung) {}

  bool MaySend() const { return options_.window == 0 || static_cast<int>(unacknowledged_.size()) < allowed_; }
  void Sent(std::int64_t sequence, absl::Time now);
  // A frame was overtaken before it could be sent: more were wanted than went.
  void Missed(absl::Time now) { missed_ = now; }
  void Acknowledged(std::int64_t sequence, absl::Time now);

  int allowed() const { return allowed_; }
  int rung() const { return rung_; }
  // Sent within the last second.
  double FramesPerSecond(absl::Time now) const;

 private:
  struct Sending {
    std::int64_t sequence = 0;
    absl::Time at;
  };

  void Adapt(absl::Duration delay, absl::Time now);
  void Coarsen(absl::Time now);

  const CreditOptions options_;
  int allowed_, rung_;
  std::deque<Sending> unacknowledged_;  // as many as the window
  std::deque<absl::Time> recent_;       // of the last second
  absl::Duration quickest_ = absl::InfiniteDuration();
  absl::Time missed_ = absl::InfinitePast();
  absl::Time adapted_ = absl::InfinitePast();    // last looked at
  absl::Time queued_ = absl::InfinitePast();     // last late
  absl::Time coarsened_ = absl::InfinitePast();  // or refined
  absl::Duration patience_;                      // before the bound is refined
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CREDIT_H_
