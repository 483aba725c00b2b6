#include "server/session/playback.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/session/pacer.h"
#include "server/session/run.h"

namespace phrenic::session {
namespace {

// A session that is farther ahead of its leader does not wait for it [s].
constexpr double kLongestWait = 2;

}  // namespace

void Playback::Start(PlayRequest request) {
  speed_ = request.speed.value_or(speed_);
  as_fast_as_possible_ = request.as_fast_as_possible;
  until_ = request.until;
  keep_playing_ = request.keep_playing;
  leader_ = std::move(request.leader);
}

bool Playback::EndsAt(double time) const { return until_ > 0 && time >= until_ - kTimeTolerance; }

double Playback::FurthestInStep(double time) const {
  const double anywhere = std::numeric_limits<double>::infinity();
  const auto leader = leader_.lock();
  if (leader == nullptr) return anywhere;
  const double reached = *leader;
  const double frame = (as_fast_as_possible_ ? 1 : speed_) / kFramesPerSecond;
  return time > reached + std::max(kLongestWait, 2 * frame) ? anywhere : reached + frame;
}

void Playback::Save(v1::SavedMoment& moment) const {
  moment.set_until_time(until_);
  moment.set_usual_speed(speed_);
}

void Playback::Restore(const v1::SavedMoment& moment) {
  as_fast_as_possible_ = moment.session().speed() == 0;
  speed_ = moment.usual_speed();
  until_ = moment.until_time();
  keep_playing_ = moment.session().keep_playing() && until_ == 0;
}

}  // namespace phrenic::session
