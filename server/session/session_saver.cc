#include "server/session/session_saver.h"

#include <utility>

namespace phrenic::session {
namespace {

// Between two saved states: the longest time that a restored session steps again.
constexpr absl::Duration kBetweenStates = absl::Seconds(2), kBetweenStatesInCluster = absl::Seconds(1);
// Between two saves of a playing session's progress: the most that is lost when the server dies.
constexpr absl::Duration kBetweenProgress = absl::Milliseconds(500);

}  // namespace

SessionSaver::SessionSaver(std::shared_ptr<store::Journal> journal, const Clock& clock, bool in_cluster)
    : journal_(std::move(journal)),
      clock_(clock),
      between_states_(in_cluster ? kBetweenStatesInCluster : kBetweenStates) {}

absl::Status SessionSaver::Flush(store::Durability durability) const {
  return journal_ == nullptr ? absl::OkStatus() : journal_->Flush(durability);
}

absl::Status SessionSaver::AwaitCopy() const { return journal_ == nullptr ? absl::OkStatus() : journal_->AwaitCopy(); }

absl::Status SessionSaver::CheckLease() const {
  return journal_ == nullptr ? absl::OkStatus() : journal_->CheckLease();
}

void SessionSaver::Forget() const {
  if (journal_ != nullptr) journal_->Forget();
}

void SessionSaver::WriteNotSaved(v1::Session& status) const {
  if (journal_ != nullptr) status.set_not_saved(std::string(journal_->problem().message()));
}

bool SessionSaver::StateIsStale(absl::Time now) const { return now - state_saved_ > between_states_; }

bool SessionSaver::ProgressDue(absl::Time now) const {
  return journal_ != nullptr && now - progress_saved_ >= kBetweenProgress;
}

void SessionSaver::SaveState(v1::SavedMoment moment, const State& state) {
  saved_tick_ = state.tick;
  state_saved_ = progress_saved_ = clock_.Now();
  journal_->Keep(std::move(moment), std::make_shared<State>(state));
}

void SessionSaver::SaveChange(v1::SavedMoment moment, const State& state) {
  const std::int64_t revision = moment.session().revision(), control = moment.control().revision();
  const bool from_start = std::exchange(from_start_, false);
  moment.set_from_start(from_start);
  const bool time_alone = revision == saved_revision_ && control == saved_control_ && !from_start;
  saved_revision_ = revision;
  saved_control_ = control;
  const bool state_due = saved_tick_ < 0 || (state.tick != saved_tick_ && (ends_ || StateIsStale(clock_.Now())));
  if (state_due || journal_->wants_state()) {
    SaveState(std::move(moment), state);
  } else {
    progress_saved_ = clock_.Now();
    journal_->Append(std::move(moment), time_alone);
  }
}

void SessionSaver::SaveProgress(v1::SavedMoment moment, const State& state, absl::Time now) {
  progress_saved_ = now;
  if (StateIsStale(now) || journal_->wants_state()) {
    SaveState(std::move(moment), state);
  } else {
    journal_->Append(std::move(moment), true);
  }
}

}  // namespace phrenic::session
