// The newest samples of a session at one interval of simulated time.
#ifndef PHRENIC_SERVER_STREAM_SAMPLE_TRACK_H_
#define PHRENIC_SERVER_STREAM_SAMPLE_TRACK_H_

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"

namespace phrenic::stream {

// The measures and probes of a session after one step. Immutable once it is in a track.
struct Sample {
  std::int64_t tick = 0;
  double time = 0;             // [s]
  double breath = 0;           // -1 to 1
  std::vector<double> values;  // in the order of Sampler::quantities(), SI units
};
using SharedSample = std::shared_ptr<const Sample>;

// A ring of samples, numbered from 1. Readers have a position each and take nothing away, so that a slow reader delays
// no other and costs no memory. The stepping thread puts samples; any thread reads.
class SampleTrack {
 public:
  // What a reader at one position gets.
  struct Part {
    std::vector<SharedSample> samples;
    std::int64_t left_out = 0;  // samples before the first one that the ring has no longer
    std::int64_t last = 0;      // the reader's next position
    bool more = false;          // there are samples after `last`
  };

  // `id` tells this track from others of the session; `interval` is in simulated seconds, above 0.
  SampleTrack(std::int64_t id, double interval) : id_(id), interval_(interval) {}

  std::int64_t id() const { return id_; }
  double interval() const { return interval_; }

  // --- the stepping thread ---
  // True if the step of `time_step` [s] that ended at `time` [s] reached a multiple of the interval which none before
  // had reached.
  bool Reaches(double time, double time_step);
  // Returns the time at which the next sample is due [s], less the tolerance for rounding. Minus infinity before the
  // first call of Reaches.
  double next_due() const;
  // Makes t = 0 due, after a reset.
  void Restart() { reached_ = -1; }
  void Put(SharedSample sample) ABSL_LOCKS_EXCLUDED(mutex_);

  // --- any thread ---
  // Returns up to `most` samples after position `after`. A position that the track has not reached counts as its end.
  Part Read(std::int64_t after, std::size_t most) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the number of samples so far, which is the position of the newest.
  std::int64_t newest() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  const std::int64_t id_;
  const double interval_;
  std::optional<std::int64_t> reached_;  // the multiple of the interval; of the stepping thread
  mutable absl::Mutex mutex_;
  std::deque<SharedSample> ring_ ABSL_GUARDED_BY(mutex_);
  std::int64_t count_ ABSL_GUARDED_BY(mutex_) = 0;  // put so far
};

// Samples that a track keeps: 82 s at 50 a second.
inline constexpr std::size_t kKeptSamples = 4096;

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_SAMPLE_TRACK_H_
