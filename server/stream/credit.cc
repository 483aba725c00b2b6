#include "server/stream/credit.h"

#include <algorithm>

namespace phrenic::stream {
namespace {

constexpr absl::Duration kLate = absl::Milliseconds(150);  // over the fastest acknowledgement: frames queue
constexpr double kFew = 12;                                // frames a second: below, the bound grows
constexpr double kRoom = 18;                               // frames a second: above, a finer bound is tried
constexpr absl::Duration kLook = absl::Milliseconds(500);  // between two adaptations: an effect shows within it
constexpr absl::Duration kMemory = absl::Seconds(5);       // a connection counts as congested after frames queued
constexpr absl::Duration kShortest = absl::Seconds(5), kLongest = absl::Seconds(60);

}  // namespace

void Credit::Sent(std::int64_t sequence, absl::Time now) {
  while (!recent_.empty() && recent_.front() <= now - absl::Seconds(1)) recent_.pop_front();
  recent_.push_back(now);
  if (options_.window > 0) unacknowledged_.push_back({sequence, now});
}

double Credit::FramesPerSecond(absl::Time now) const {
  return static_cast<double>(
      std::count_if(recent_.begin(), recent_.end(), [now](absl::Time at) { return at > now - absl::Seconds(1); }));
}

void Credit::Acknowledged(std::int64_t sequence, absl::Time now) {
  absl::Time sent = absl::InfinitePast();
  for (; !unacknowledged_.empty() && unacknowledged_.front().sequence <= sequence; unacknowledged_.pop_front()) {
    sent = unacknowledged_.front().at;
  }
  if (sent == absl::InfinitePast()) return;
  quickest_ = std::min(quickest_, now - sent);
  if (adapted_ == absl::InfinitePast()) adapted_ = now;
  if (now - adapted_ >= kLook) Adapt(now - sent, now);
}

void Credit::Adapt(absl::Duration delay, absl::Time now) {
  adapted_ = now;
  const double pace = FramesPerSecond(now);
  const bool wanted_more = missed_ > now - absl::Seconds(1);
  const bool few = pace < kFew && wanted_more;
  if (delay - quickest_ > kLate) {
    queued_ = now;
    if (allowed_ > 1) {
      --allowed_;
    } else if (few) {
      Coarsen(now);
    }
  } else if (wanted_more && now - queued_ > kMemory && allowed_ < options_.window) {
    ++allowed_;
  } else if (few) {
    Coarsen(now);
  } else if (bound_level_ > options_.bound_level && (pace > kRoom || !wanted_more) && now - coarsened_ > interval_) {
    --bound_level_;
    coarsened_ = now;
  }
}

// A bound that congested the connection before is retried at growing intervals.
void Credit::Coarsen(absl::Time now) {
  if (!options_.may_coarsen || bound_level_ >= kCoarsestBoundLevel) return;
  ++bound_level_;
  coarsened_ = now;
  interval_ = std::clamp(2 * interval_, kShortest, kLongest);
}

}  // namespace phrenic::stream
