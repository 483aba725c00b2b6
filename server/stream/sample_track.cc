#include "server/stream/sample_track.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace phrenic::stream {
namespace {

constexpr double kGridTolerance = 1e-9;  // rounding of a long sum of steps [s]

std::int64_t MultipleAt(double time, double interval) {
  return static_cast<std::int64_t>(std::floor((time + kGridTolerance) / interval));
}

}  // namespace

bool SampleTrack::Reaches(double time, double time_step) {
  const std::int64_t now = MultipleAt(time, interval_);
  const std::int64_t before = reached_.value_or(MultipleAt(time - time_step, interval_));
  reached_ = now;
  return now > before;
}

double SampleTrack::next_due() const {
  if (!reached_.has_value()) return -std::numeric_limits<double>::infinity();
  return static_cast<double>(*reached_ + 1) * interval_ - kGridTolerance;
}

void SampleTrack::Put(SharedSample sample) {
  absl::MutexLock lock(&mutex_);
  ring_.push_back(std::move(sample));
  if (ring_.size() > kKeptSamples) ring_.pop_front();
  ++count_;
}

SampleTrack::Part SampleTrack::Read(std::int64_t after, std::size_t most) const {
  absl::MutexLock lock(&mutex_);
  const std::int64_t oldest = count_ - static_cast<std::int64_t>(ring_.size());  // position before the first kept one
  const std::int64_t from = std::clamp(after, oldest, count_);
  Part part;
  part.left_out = std::max<std::int64_t>(0, oldest - after);
  part.last = std::min(count_, from + static_cast<std::int64_t>(most));
  part.more = part.last < count_;
  part.samples.assign(ring_.begin() + (from - oldest), ring_.begin() + (part.last - oldest));
  return part;
}

std::int64_t SampleTrack::newest() const {
  absl::MutexLock lock(&mutex_);
  return count_;
}

}  // namespace phrenic::stream
