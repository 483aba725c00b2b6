// Samples a session's measures by simulated time, once for all readers.
#ifndef PHRENIC_SERVER_STREAM_SAMPLER_H_
#define PHRENIC_SERVER_STREAM_SAMPLER_H_

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/samples.pb.h"
#include "server/mechanics/model.h"
#include "server/schema/clock.h"
#include "server/stream/sample_track.h"

namespace phrenic::stream {

// Thread-safe. The stepping thread calls Note after each step: a comparison of two numbers unless a sample is due. A
// due sample is evaluated there, so that it is of exactly that step, and shared by all tracks. Session owns it.
class Sampler {
 public:
  // `clock` outlives the sampler.
  Sampler(std::shared_ptr<const Model> model, const Clock& clock);

  // Returns the measures, in the scene's order, and then the probes.
  const std::vector<v1::SampledQuantity>& quantities() const { return quantities_; }

  // Returns the track of an interval [simulated s], and makes it if it is new. It is kept as long as the result
  // exists, and for `keep` after this call. RESOURCE_EXHAUSTED, naming the field, above kMostTracks intervals other
  // than kDefaultInterval, which is always admitted; the reason of Close after Close.
  absl::StatusOr<std::shared_ptr<const SampleTrack>> Track(double interval, absl::Duration keep)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the sample of a state. Any thread.
  Sample Evaluate(const v1::Parameters& parameters, const State& state) const;
  // Refuses later readers with `reason`. A second call has no effect.
  void Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the reason of Close; nullopt before.
  std::optional<absl::Status> closed() const ABSL_LOCKS_EXCLUDED(mutex_);

  // --- the stepping thread ---
  // Takes the samples that are due after a step.
  void Note(const v1::Parameters& parameters, const State& state) {
    if (state.time >= next_due_.load(std::memory_order_relaxed)) Take(parameters, state);
  }
  // Takes a sample at t = 0, after a reset.
  void Restart(const v1::Parameters& parameters, const State& state) ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns the number of samples that were evaluated for tracks.
  std::int64_t evaluations() const { return evaluations_; }

 private:
  struct Entry {
    std::shared_ptr<SampleTrack> track;
    absl::Time kept_until;
  };

  void Take(const v1::Parameters& parameters, const State& state) ABSL_LOCKS_EXCLUDED(mutex_);
  // Removes tracks without readers.
  void DropUnread() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::shared_ptr<const Model> model_;
  const Clock& clock_;
  const std::vector<v1::SampledQuantity> quantities_;
  mutable absl::Mutex mutex_;
  std::vector<Entry> tracks_ ABSL_GUARDED_BY(mutex_);  // at most kMostTracks + 1
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);
  std::int64_t last_id_ ABSL_GUARDED_BY(mutex_) = 0;
  // The smallest next_due of all tracks [simulated s]; infinity without a track. Written under the mutex.
  std::atomic<double> next_due_ = std::numeric_limits<double>::infinity();
  std::atomic<std::int64_t> evaluations_ = 0;
};

// The interval of graphs [simulated s]. Pages depend on it, so that other readers cannot take its place.
inline constexpr double kDefaultInterval = 0.02;

// Most other intervals of one session at a time.
inline constexpr std::size_t kMostTracks = 4;

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_SAMPLER_H_
