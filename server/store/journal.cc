#include <utility>

#include "server/store/store.h"

namespace phrenic::store {
namespace {

// Moments that may wait while nothing can be written.
constexpr std::size_t kMostMoments = 1000;

}  // namespace

void Journal::Append(v1::SavedMoment moment, bool time_alone) {
  absl::MutexLock lock(&store_.mutex_);
  if (forgotten_) return;
  const bool replaces = time_alone && time_alone_;
  if (!replaces) ++sequence_;
  time_alone_ = time_alone;
  auto& moments = pending_.moments;
  if (!moments.empty() && moments.back().first == sequence_) {
    moments.back().second = std::move(moment);
  } else if (moments.size() < kMostMoments) {
    moments.emplace_back(sequence_, std::move(moment));
  }
  store_.Enqueue(*this);
}

void Journal::Keep(v1::SavedMoment moment, std::shared_ptr<const State> state) {
  absl::MutexLock lock(&store_.mutex_);
  if (forgotten_) return;
  time_alone_ = false;
  pending_.moments.clear();
  pending_.kept = Kept{++sequence_, std::move(moment), std::move(state)};
  store_.Enqueue(*this);
}

void Journal::Forget() {
  absl::MutexLock lock(&store_.mutex_);
  forgotten_ = true;
  pending_ = {};
  pending_.forgotten = true;
  store_.Enqueue(*this);
}

absl::Status Journal::Flush() {
  struct Wait {
    const Journal* journal;
    std::int64_t requested;
  } wait{this, 0};
  absl::MutexLock lock(&store_.mutex_);
  wait.requested = requested_;
  const auto settled =
      +[](Wait* waits) { return waits->journal->written_ >= waits->requested || !waits->journal->problem_.ok(); };
  store_.mutex_.Await(absl::Condition(settled, &wait));
  return written_ >= wait.requested ? absl::OkStatus() : problem_;
}

absl::Status Journal::problem() const {
  absl::MutexLock lock(&store_.mutex_);
  return problem_;
}

bool Journal::wants_state() const {
  absl::MutexLock lock(&store_.mutex_);
  return pending_.moments.size() >= kMostMoments;
}

}  // namespace phrenic::store
