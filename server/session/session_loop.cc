// The stepping thread of a session: commands between steps, steps in bursts of one frame.
#include <pthread.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/measures/readings.h"
#include "server/session/run.h"
#include "server/session/session.h"

namespace phrenic::session {
namespace {

// Farther ahead of the session that it plays in step with a session does not wait [s].
constexpr double kLongestWait = 2;
// Until one that waits looks again how far the other is.
constexpr absl::Duration kLookAgain = absl::Milliseconds(1);

}  // namespace

void Session::Loop() {
  pthread_setname_np(pthread_self(), "stepping");
  while (ServeCommands()) {
    if (!Steps()) continue;
    share_.Begin(clock_.Now(), ThreadCpu());
    Burst();
    share_.End(ThreadCpu());
  }
  ended_.Notify();
}

bool Session::ServeCommands() {
  std::deque<Command> commands;
  bool stopped = false;
  {
    absl::MutexLock lock(&mutex_);
    const absl::Time next = std::min(NextBurst(), control_.next_expiry());
    if (!Called() && next > clock_.Now()) clock_.Await(mutex_, absl::Condition(this, &Session::Called), next);
    commands.swap(commands_);
    stopped = stopped_.has_value();
    called_ = false;
  }
  if (control_.next_expiry() <= clock_.Now()) control_.Expire(clock_.Now());
  for (const Command& command : commands) {
    if (!stopped) command.act();
    command.done->Notify();
  }
  NoteControl();
  if (stopped && journal_ != nullptr) Tell();  // where it stands, for the store
  if (stopped) EndJob(absl::CancelledError("the session ended while it was being stepped"));
  return !stopped;
}

absl::Time Session::NextBurst() const {
  const bool playing = state_ == v1::SESSION_STATE_PLAYING;
  if (job_ == nullptr && !playing) return absl::InfiniteFuture();
  if (job_ == nullptr && WaitsInStep()) return clock_.Now() + kLookAgain;
  const bool at_once = job_ != nullptr || as_fast_as_possible_;
  return std::max(share_.RestsUntil(clock_.Now()), at_once ? absl::InfinitePast() : pacer_.next_frame());
}

bool Session::Steps() const {
  if (job_ == nullptr && (state_ != v1::SESSION_STATE_PLAYING || WaitsInStep())) return false;
  return share_.RestsUntil(clock_.Now()) <= clock_.Now();
}

bool Session::WaitsInStep() const {
  return run_.state().time + run_.parameters().time_step() > FurthestInStep() + kTimeTolerance;
}

// The time up to which it need not wait for the session that it plays in step with [s].
double Session::FurthestInStep() const {
  const double anywhere = std::numeric_limits<double>::infinity();
  const auto leader = leader_.lock();
  if (leader == nullptr) return anywhere;
  const double reached = *leader;
  const double frame = (as_fast_as_possible_ ? 1 : speed_) / kFramesPerSecond;
  return run_.state().time > reached + std::max(kLongestWait, 2 * frame) ? anywhere : reached + frame;
}

// Steps until the time of the next frame is reached, in the simulation or on the wall, or somebody calls.
void Session::Burst() {
  const absl::Time start = clock_.Now();
  const absl::Time end = start + absl::Seconds(1 / kFramesPerSecond);
  const double anywhere = std::numeric_limits<double>::infinity();
  const double due = as_fast_as_possible_ ? anywhere : pacer_.Target(start, run_.state().time);
  const double target = job_ != nullptr ? anywhere : std::min(due, FurthestInStep());
  bool stepping = true;
  while (stepping && !called_) {
    if (run_.state().time + run_.parameters().time_step() > target + kTimeTolerance) break;
    stepping = StepOnce() && !Finished() && clock_.Now() < end;
  }
  const absl::Time now = clock_.Now();
  if (run_.divergence().has_value()) {
    Halt(v1::SESSION_STATE_DIVERGED);
    EndJob(absl::OutOfRangeError(Describe(*run_.divergence())));
  } else if (job_ != nullptr && job_->left == 0) {
    Halt(v1::SESSION_STATE_PAUSED);
    EndJob(absl::OkStatus());
  } else if (Finished()) {
    Halt(v1::SESSION_STATE_PAUSED);
  } else {
    NoteProgress();
    SaveProgress(now);
    // Of one that fell due meanwhile the steps are yet to come.
    if (pacer_.FrameDue(start)) OfferFrame(now);
  }
}

bool Session::StepOnce() {
  if (!run_.Step().ok()) return false;
  if (state_ == v1::SESSION_STATE_PLAYING) *reached_ = run_.state().time;
  if (!waiting_updates_.empty()) ApplyDueUpdates();
  if (job_ != nullptr) --job_->left;
  return true;
}

// Whether the steps that were asked for have been taken.
bool Session::Finished() const {
  if (job_ != nullptr) return job_->left == 0;
  return until_ > 0 && run_.state().time >= until_ - kTimeTolerance;
}

absl::Status Session::StartPlaying(std::optional<double> speed, bool as_fast_as_possible, double until,
                                   std::weak_ptr<const ReachedTime> leader) {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  const double time = run_.state().time;
  if (until > 0 && until <= time + kTimeTolerance) {
    return absl::InvalidArgumentError(absl::StrCat("until_time: ", until, " s is not after the session's time, ", time,
                                                   " s; ask for a later time, or reset the session first"));
  }
  EndJob(absl::AbortedError("the session was played while it was being stepped"));
  speed_ = speed.value_or(speed_);
  as_fast_as_possible_ = as_fast_as_possible;
  until_ = until;
  leader_ = std::move(leader);
  *reached_ = time;
  state_ = v1::SESSION_STATE_PLAYING;
  pacer_.Start(clock_.Now(), time, speed_);
  meter_.Start(clock_.Now(), run_.state().tick, time);
  Changed();
  return absl::OkStatus();
}

absl::Status Session::StartJob(std::shared_ptr<StepJob> job, std::optional<std::int64_t> expected_tick) {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  if (job_ != nullptr) return absl::AbortedError("somebody else is stepping the session; try again when it is done");
  if (state_ == v1::SESSION_STATE_PLAYING) Halt(v1::SESSION_STATE_PAUSED);
  const std::int64_t tick = run_.state().tick;
  if (expected_tick.has_value() && *expected_tick != tick) {
    return absl::AbortedError(
        absl::StrCat("expected_tick: ", *expected_tick, " is stale, the session is at tick ", tick, "; read it again"));
  }
  job_ = std::move(job);
  meter_.Start(clock_.Now(), tick, run_.state().time);
  return absl::OkStatus();
}

// Stops stepping; the frame of the last good state is shown.
void Session::Halt(v1::SessionState state) {
  if (state_ == v1::SESSION_STATE_PLAYING || job_ != nullptr) {
    meter_.Update(clock_.Now(), run_.state().tick, run_.state().time, true);
  }
  if (state_ != state) ++revision_;
  state_ = state;
  *reached_ = std::numeric_limits<double>::infinity();
  until_ = 0;
  Tell();
  OfferFrame(clock_.Now());
}

void Session::EndJob(absl::Status status) {
  if (job_ == nullptr) return;
  job_->status = std::move(status);
  job_->result.session = this->status();
  job_->result.state_hash = HashText(run_.state());
  job_->result.measures = ReadMeasures(*model_, MakeEvalContext(*model_, run_.parameters(), run_.state()));
  const auto job = std::exchange(job_, nullptr);
  job->done.Notify();
}

void Session::OfferFrame(absl::Time now) {
  pacer_.FrameMade(now);
  if (run_.state().tick == framed_tick_) return;
  framed_tick_ = run_.state().tick;
  auto snapshot = std::make_shared<stream::Snapshot>();
  snapshot->sequence = ++frames_;
  snapshot->state = run_.state();
  snapshot->parameters = run_.parameters();
  snapshot->made = now;
  publisher_.Offer(std::move(snapshot));
}

// State or parameters are others than before.
void Session::Changed() {
  ++revision_;
  Tell();
}

void Session::Tell() {
  told_control_ = control_.state().revision;
  v1::Session status;
  auto access = std::make_shared<const Access>(Access{control_.state().account, control_.state().links});
  {
    absl::MutexLock lock(&mutex_);
    access_ = std::move(access);
    status_.set_state(state_);
    status_.set_time(run_.state().time);
    status_.set_tick(run_.state().tick);
    *status_.mutable_parameters() = run_.parameters();
    status_.set_revision(revision_);
    status_.set_speed(as_fast_as_possible_ ? 0 : speed_);
    status_.set_largest_stable_step(stable_step_);
    *status_.mutable_pace() = meter_.pace();
    status_.set_waiting_updates(static_cast<int>(waiting_updates_.size()));
    *status_.mutable_control() = control_.Describe(clock_.Now());
    *status_.mutable_pulls() = DescribePulls(*model_, run_.state().pulls);
    WriteResiduals(status_);
    if (run_.divergence().has_value()) {
      *status_.mutable_divergence() = *run_.divergence();
    } else {
      status_.clear_divergence();
    }
    status = status_;
  }
  WriteNotSaved(status);
  publisher_.Announce(status);
  SaveChange(std::move(status));
}

// How well the last step was solved, and how well the present state keeps the constraints, where there are any.
void Session::WriteResiduals(v1::Session& status) const {
  status.clear_solver_residual();
  status.clear_solver_iterations();
  if (run_.effort().iterations() > 0) {
    status.set_solver_residual(run_.effort().residual());
    status.set_solver_iterations(run_.effort().iterations());
  }
  if (model_->constraints.empty()) return;
  const ConstraintResidual residual = LargestResidual(*model_, run_.state());
  status.set_constraint_residual(residual.metres);
  status.set_residual_constraint(std::string(residual.constraint));
}

// Time goes on; viewers hear of it about once a second.
void Session::NoteProgress() {
  const bool measured = meter_.Update(clock_.Now(), run_.state().tick, run_.state().time);
  v1::Session status;
  {
    absl::MutexLock lock(&mutex_);
    status_.set_time(run_.state().time);
    status_.set_tick(run_.state().tick);
    WriteResiduals(status_);
    if (!measured) return;
    *status_.mutable_pace() = meter_.pace();
    status = status_;
  }
  WriteNotSaved(status);
  publisher_.Announce(status);
}

absl::Status Session::CheckNotDiverged() const {
  if (!run_.divergence().has_value()) return absl::OkStatus();
  return absl::FailedPreconditionError(Describe(*run_.divergence()));
}

}  // namespace phrenic::session
