#include <utility>

#include "absl/strings/str_cat.h"
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

absl::Status Journal::Flush(Durability durability) {
  struct Wait {
    const Journal* journal;
    std::int64_t requested;
  } wait{this, 0};
  absl::MutexLock lock(&store_.mutex_);
  wait.requested = requested_;
  const bool power = durability == Durability::kPower;
  if (power && written_ < requested_) store_.sync_wanted_ = true;  // with the transaction that is waited for
  const auto settled =
      +[](Wait* waits) { return waits->journal->written_ >= waits->requested || !waits->journal->problem_.ok(); };
  store_.mutex_.Await(absl::Condition(settled, &wait));
  if (written_ < wait.requested) return problem_;
  return power ? store_.AwaitSync() : absl::OkStatus();
}

absl::Status Journal::AwaitCopy() {
  // Between two looks at the lease, which ends by the clock.
  constexpr absl::Duration kLook = absl::Milliseconds(50);
  struct Wait {
    const Journal* journal;
    std::int64_t requested;
  } wait{this, 0};
  absl::MutexLock lock(&store_.mutex_);
  if (store_.ownership_ == nullptr) return absl::OkStatus();
  wait.requested = requested_;
  const auto settled =
      +[](Wait* waits) { return waits->journal->copied_ >= waits->requested || waits->journal->lost_; };
  while (!store_.mutex_.AwaitWithTimeout(absl::Condition(settled, &wait), kLook)) {
    if (absl::Status lease = LeaseProblem(); !lease.ok()) return lease;
    if (lags_) store_.whole_.insert(id_);
  }
  return copied_ >= wait.requested ? absl::OkStatus() : LeaseProblem();
}

absl::Status Journal::LeaseProblem() const {
  store_.mutex_.AssertHeld();
  if (store_.ownership_ == nullptr) return absl::OkStatus();
  if (!lost_) return store_.ownership_->CheckLease(id_);
  return absl::AbortedError(
      absl::StrCat("session ", id_, " continues on another server, without this change; repeat the change there"));
}

absl::Status Journal::CheckLease() const {
  absl::MutexLock lock(&store_.mutex_);
  return LeaseProblem();
}

absl::Status Journal::problem() const {
  absl::MutexLock lock(&store_.mutex_);
  if (!problem_.ok() || store_.ownership_ == nullptr) return problem_;
  if (absl::Status lease = LeaseProblem(); !lease.ok() || !lags_) return lease;
  return absl::UnavailableError(
      absl::StrCat("Redis does not take the last changes of session ", id_,
                   ", which another server would need; they are not acknowledged until then"));
}

bool Journal::wants_state() const {
  absl::MutexLock lock(&store_.mutex_);
  return pending_.moments.size() >= kMostMoments;
}

}  // namespace phrenic::store
