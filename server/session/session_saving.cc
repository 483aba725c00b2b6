// What a session's store has of it: each change with its tick, its progress, and a state now and then.
#include <utility>

#include "server/session/saving.h"
#include "server/session/session.h"

namespace phrenic::session {
namespace {

// A session that is restored steps again through what came after its last state: at most this long.
constexpr absl::Duration kStates = absl::Seconds(2), kStatesInCluster = absl::Seconds(1);
// Of a session that plays: what is lost with the server.
constexpr absl::Duration kProgress = absl::Milliseconds(500);

}  // namespace

absl::Status Session::Flush() const { return journal_ == nullptr ? absl::OkStatus() : journal_->Flush(); }

absl::StatusOr<v1::Session> Session::Saved() {
  const absl::Status saved = Flush();
  if (absl::IsAborted(saved)) return saved;
  v1::Session now = status();
  if (!saved.ok()) publisher_.Announce(now);  // viewers were told before the store was asked
  return now;
}

void Session::WriteNotSaved(v1::Session& status) const {
  if (journal_ != nullptr) status.set_not_saved(std::string(journal_->problem().message()));
}

void Session::Forget() {
  if (journal_ != nullptr) journal_->Forget();
}

// As it was when it was told this; its run stands there already.
void Session::GoOn(const v1::SavedMoment& told) {
  const v1::Session& session = told.session();
  state_ = session.state();
  if (session.has_divergence()) run_.set_divergence(session.divergence());
  as_fast_as_possible_ = session.speed() == 0;
  speed_ = told.usual_speed();
  until_ = told.until_time();
  revision_ = session.revision();
  for (const v1::SavedUpdate& update : told.waiting()) waiting_updates_.emplace(update.at_tick(), update.parameters());
  absl::MutexLock lock(&mutex_);
  *status_.mutable_create_time() = session.create_time();
}

// All of what it was told but the session itself.
v1::SavedMoment Session::Moment() const {
  v1::SavedMoment moment;
  moment.set_until_time(until_);
  moment.set_usual_speed(speed_);
  *moment.mutable_control() = SaveControl(control_.state());
  for (const auto& [tick, parameters] : waiting_updates_) {
    v1::SavedUpdate& update = *moment.add_waiting();
    update.set_at_tick(tick);
    *update.mutable_parameters() = parameters;
  }
  return moment;
}

absl::Duration Session::StatePause() const { return epoch_ > 0 ? kStatesInCluster : kStates; }

void Session::SaveState(v1::SavedMoment moment) {
  saved_tick_ = run_.state().tick;
  state_saved_ = progress_saved_ = clock_.Now();
  journal_->Keep(std::move(moment), std::make_shared<State>(run_.state()));
}

void Session::SaveChange(v1::Session status) {
  if (journal_ == nullptr) return;
  v1::SavedMoment moment = Moment();
  *moment.mutable_session() = std::move(status);
  const bool from_start = std::exchange(from_start_, false);
  moment.set_from_start(from_start);
  const bool time_alone = revision_ == saved_revision_ && control_.state().revision == saved_control_ && !from_start;
  saved_revision_ = revision_;
  saved_control_ = control_.state().revision;
  const bool stale = run_.state().tick != saved_tick_ && clock_.Now() - state_saved_ > StatePause();
  if (saved_tick_ < 0 || stale || journal_->wants_state()) {
    SaveState(std::move(moment));
  } else {
    progress_saved_ = clock_.Now();
    journal_->Append(std::move(moment), time_alone);
  }
}

void Session::SaveProgress(absl::Time now) {
  if (journal_ == nullptr || now - progress_saved_ < kProgress) return;
  progress_saved_ = now;
  v1::SavedMoment moment = Moment();
  *moment.mutable_session() = status();
  if (now - state_saved_ > StatePause() || journal_->wants_state()) {
    SaveState(std::move(moment));
  } else {
    journal_->Append(std::move(moment), true);
  }
}

}  // namespace phrenic::session
