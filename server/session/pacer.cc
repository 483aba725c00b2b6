#include "server/session/pacer.h"

#include <algorithm>
#include <limits>

namespace phrenic::session {
namespace {

constexpr double kCatchUp = 0.1;  // of wall-clock time [s]
const absl::Duration kFrameInterval = absl::Seconds(1 / kFramesPerSecond);

}  // namespace

void Pacer::Start(absl::Time now, double time, double speed) {
  start_ = now;
  start_time_ = time;
  speed_ = speed;
  next_frame_ = now + kFrameInterval;
}

double Pacer::Target(absl::Time now, double time) {
  if (speed_ == 0) return std::numeric_limits<double>::infinity();
  const double target = start_time_ + speed_ * absl::ToDoubleSeconds(now - start_);
  const double furthest = time + speed_ * kCatchUp;
  if (target <= furthest && now >= start_) return target;
  // Starts again here: the session is too slow, or the clock was set back.
  start_ = now;
  start_time_ = std::clamp(target, time, furthest);
  return start_time_;
}

void Pacer::FrameMade(absl::Time now) { next_frame_ = std::max(next_frame_ + kFrameInterval, now); }

}  // namespace phrenic::session
