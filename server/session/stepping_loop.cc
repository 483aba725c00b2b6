#include "server/session/stepping_loop.h"

#include <pthread.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/schema/thread_cpu.h"

namespace phrenic::session {
namespace {

// Between two looks at how far the leader is.
constexpr absl::Duration kLookAgain = absl::Milliseconds(1);

}  // namespace

SteppingLoop::SteppingLoop(RunningSession session, double cpu_share, const Clock& clock, SessionReporter& reporter,
                           bool held)
    : clock_(clock),
      reporter_(reporter),
      commands_(clock),
      session_(std::move(session)),
      cpu_share_(cpu_share),
      held_(held) {
  const State& state = session_.run.state();
  if (session_.phase == v1::SESSION_STATE_PLAYING) *reached_ = state.time;
  pacer_.Start(clock.Now(), state.time, session_.playback.speed());
  session_.meter.Start(clock.Now(), state.tick, state.time);
  reporter_.Report(session_);
  OfferFrame(clock.Now());
  thread_ = std::thread([this] { Loop(); });
}

SteppingLoop::~SteppingLoop() { thread_.join(); }

absl::Status SteppingLoop::CallAs(std::string_view token, absl::FunctionRef<absl::Status()> act) {
  absl::Status result;
  const absl::Status called = Call([&] {
    result = session_.control.Check(token, clock_.Now());
    if (result.ok()) result = act();
  });
  return called.ok() ? result : called;
}

void SteppingLoop::Loop() {
  pthread_setname_np(pthread_self(), "stepping");
  while (ServeCommands()) {
    if (!MayStep()) continue;
    cpu_share_.Begin(clock_.Now(), absl::Seconds(ThreadCpuSeconds()));
    Burst();
    cpu_share_.End(absl::Seconds(ThreadCpuSeconds()));
  }
  ended_.Notify();
}

// Waits for commands or the next burst, and runs the commands. Returns false once the loop is stopped.
bool SteppingLoop::ServeCommands() {
  const CommandQueue::Batch batch = commands_.Await(std::min(NextBurst(), session_.control.next_expiry()));
  if (session_.control.next_expiry() <= clock_.Now()) session_.control.Expire(clock_.Now());
  CommandQueue::Finish(batch);
  reporter_.ReportControl(session_);
  if (!batch.closed) return true;
  reporter_.ReportEnd(session_);
  EndJob(absl::CancelledError("the session ended while it was being stepped"));
  return false;
}

absl::Time SteppingLoop::NextBurst() const {
  if (job_ == nullptr && !Plays()) return absl::InfiniteFuture();
  if (job_ == nullptr && WaitsInStep()) return clock_.Now() + kLookAgain;
  const bool at_once = job_ != nullptr || session_.playback.as_fast_as_possible();
  return std::max(cpu_share_.RestsUntil(clock_.Now()), at_once ? absl::InfinitePast() : pacer_.next_frame());
}

bool SteppingLoop::MayStep() const {
  if (job_ == nullptr && (!Plays() || WaitsInStep())) return false;
  return cpu_share_.RestsUntil(clock_.Now()) <= clock_.Now();
}

bool SteppingLoop::WaitsInStep() const {
  const double time = session_.run.state().time;
  return time + session_.run.parameters().time_step() > session_.playback.FurthestInStep(time) + kTimeTolerance;
}

// Steps until the next frame's time is reached, in the simulation or on the wall, or until a command waits.
void SteppingLoop::Burst() {
  const absl::Time start = clock_.Now();
  const absl::Time end = start + absl::Seconds(1 / kFramesPerSecond);
  const double anywhere = std::numeric_limits<double>::infinity();
  const double time = session_.run.state().time;
  const double due = session_.playback.as_fast_as_possible() ? anywhere : pacer_.Target(start, time);
  const double target = job_ != nullptr ? anywhere : std::min(due, session_.playback.FurthestInStep(time));
  bool stepping = true;
  while (stepping && !commands_.called()) {
    if (session_.run.state().time + session_.run.parameters().time_step() > target + kTimeTolerance) break;
    stepping = StepOnce() && !Finished() && clock_.Now() < end;
  }
  EndBurst(start);
}

void SteppingLoop::EndBurst(absl::Time start) {
  const absl::Time now = clock_.Now();
  if (session_.run.divergence().has_value()) {
    Halt(v1::SESSION_STATE_DIVERGED);
    EndJob(absl::OutOfRangeError(Describe(*session_.run.divergence())));
  } else if (job_ != nullptr && job_->left == 0) {
    Halt(v1::SESSION_STATE_PAUSED);
    EndJob(absl::OkStatus());
  } else if (Finished()) {
    Halt(v1::SESSION_STATE_PAUSED);
  } else {
    const bool measured = session_.meter.Update(now, session_.run.state().tick, session_.run.state().time);
    reporter_.ReportProgress(session_, measured, now);
    // A frame that became due during the burst waits for the next one, which steps up to it.
    if (pacer_.FrameDue(start)) OfferFrame(now);
  }
}

bool SteppingLoop::StepOnce() {
  if (!session_.run.Step().ok()) return false;
  reporter_.NoteStep(session_);
  if (session_.phase == v1::SESSION_STATE_PLAYING) *reached_ = session_.run.state().time;
  if (!session_.updates.empty()) ApplyDueUpdates();
  if (job_ != nullptr) --job_->left;
  return true;
}

// True if the requested steps have been taken.
bool SteppingLoop::Finished() const {
  return job_ != nullptr ? job_->left == 0 : session_.playback.EndsAt(session_.run.state().time);
}

absl::Status SteppingLoop::CheckNotDiverged() const {
  if (!session_.run.divergence().has_value()) return absl::OkStatus();
  return absl::FailedPreconditionError(Describe(*session_.run.divergence()));
}

absl::Status SteppingLoop::Play(const PlayRequest& request) {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  const double time = session_.run.state().time;
  if (request.until > 0 && request.until <= time + kTimeTolerance) {
    return absl::InvalidArgumentError(absl::StrCat("until_time: ", request.until,
                                                   " s is not after the session's time, ", time,
                                                   " s; ask for a later time, or reset the session first"));
  }
  EndJob(absl::AbortedError("the session was played while it was being stepped"));
  session_.playback.Start(request);
  *reached_ = time;
  session_.phase = v1::SESSION_STATE_PLAYING;
  pacer_.Start(clock_.Now(), time, session_.playback.speed());
  session_.meter.Start(clock_.Now(), session_.run.state().tick, time);
  NoteChange();
  return absl::OkStatus();
}

void SteppingLoop::Pause(const std::string& reason) {
  EndJob(absl::AbortedError(reason));
  if (session_.phase == v1::SESSION_STATE_PLAYING) Halt(v1::SESSION_STATE_PAUSED);
}

void SteppingLoop::Release() {
  if (!std::exchange(held_, false)) return;
  const State& state = session_.run.state();
  pacer_.Start(clock_.Now(), state.time, session_.playback.speed());
  session_.meter.Start(clock_.Now(), state.tick, state.time);
}

void SteppingLoop::Reset() {
  EndJob(absl::AbortedError("the session was reset while it was being stepped"));
  session_.run.Reset();
  session_.updates.Clear();
  reporter_.NoteReset(session_);
  session_.phase = v1::SESSION_STATE_PAUSED;
  ++session_.revision;
  Halt(v1::SESSION_STATE_PAUSED);
}

absl::Status SteppingLoop::StartJob(std::shared_ptr<StepJob> job, std::optional<std::int64_t> expected_tick) {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  if (job_ != nullptr) return absl::AbortedError("another caller is stepping the session; try again when it is done");
  if (session_.phase == v1::SESSION_STATE_PLAYING) Halt(v1::SESSION_STATE_PAUSED);
  const std::int64_t tick = session_.run.state().tick;
  if (expected_tick.has_value() && *expected_tick != tick) {
    return absl::AbortedError(
        absl::StrCat("expected_tick: ", *expected_tick, " is stale, the session is at tick ", tick, "; read it again"));
  }
  job_ = std::move(job);
  session_.meter.Start(clock_.Now(), tick, session_.run.state().time);
  return absl::OkStatus();
}

void SteppingLoop::CancelJob(const StepJob& job, absl::Status status) {
  if (job_.get() == &job) EndJob(std::move(status));
}

void SteppingLoop::EndJob(absl::Status status) {
  if (job_ == nullptr) return;
  job_->status = std::move(status);
  job_->result.session = reporter_.status();
  job_->result.state_hash = HashText(session_.run.state());
  job_->result.measures = ReadMeasures(
      session_.run.model(), MakeEvalContext(session_.run.model(), session_.run.parameters(), session_.run.state()));
  job_->result.frame = reporter_.newest_frame();
  const auto job = std::exchange(job_, nullptr);
  job->done.Notify();
}

// Stops stepping and shows the last good state.
void SteppingLoop::Halt(v1::SessionState state) {
  if (session_.phase == v1::SESSION_STATE_PLAYING || job_ != nullptr) {
    session_.meter.Update(clock_.Now(), session_.run.state().tick, session_.run.state().time, true);
  }
  if (session_.phase != state) ++session_.revision;
  session_.phase = state;
  *reached_ = std::numeric_limits<double>::infinity();
  session_.playback.Stop();
  reporter_.Report(session_);
  OfferFrame(clock_.Now());
}

absl::StatusOr<Fork> SteppingLoop::MakeFork() const {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  return Fork{session_.run.parameters(), session_.run.state(), session_.stable_step};
}

absl::StatusOr<PresentState> SteppingLoop::ReadState() {
  if (absl::Status good = CheckNotDiverged(); !good.ok()) return good;
  if (job_ == nullptr && session_.phase != v1::SESSION_STATE_PLAYING) OfferFrame(clock_.Now());
  PresentState present{session_.run.parameters(), reporter_.newest_frame()};
  if (present.state().tick != session_.run.state().tick) present.parameters = present.frame->parameters;
  return present;
}

absl::Status SteppingLoop::CheckRevision(std::optional<std::int64_t> expected) const {
  if (!expected.has_value() || *expected == session_.revision) return absl::OkStatus();
  return absl::AbortedError(absl::StrCat("expected_revision: ", *expected, " is stale, the session is at revision ",
                                         session_.revision, "; read it again and repeat the change"));
}

absl::Status SteppingLoop::Update(const v1::Parameters& changes, double stable_step,
                                  std::optional<std::int64_t> expected_revision, std::optional<std::int64_t> at_tick) {
  if (absl::Status good = CheckRevision(expected_revision); !good.ok()) return good;
  const std::int64_t tick = session_.run.state().tick;
  if (at_tick.value_or(tick) < tick) {
    return absl::FailedPreconditionError(absl::StrCat("apply_at_tick: ", *at_tick, " is past, the session is at tick ",
                                                      tick, "; name a later tick, or reset the session first"));
  }
  if (at_tick.value_or(tick) == tick) {
    Merge(changes, stable_step);
    return absl::OkStatus();
  }
  if (absl::Status added = session_.updates.Add(*at_tick, changes); !added.ok()) return added;
  NoteChange();
  return absl::OkStatus();
}

void SteppingLoop::Merge(const v1::Parameters& changes, double stable_step) {
  v1::Parameters parameters = session_.run.parameters();
  parameters.MergeFrom(changes);
  session_.run.set_parameters(parameters);
  session_.stable_step = stable_step;
  NoteChange();
}

// Computes the stable step here, as the parameters at this tick were unknown when the update was requested.
void SteppingLoop::ApplyDueUpdates() {
  while (const auto changes = session_.updates.TakeDue(session_.run.state().tick)) {
    v1::Parameters parameters = session_.run.parameters();
    parameters.MergeFrom(*changes);
    Merge(*changes, StableStepFor(session_.run.model(), parameters, session_.run.parameters(), session_.stable_step));
  }
}

absl::Status SteppingLoop::ChangePulls(const std::vector<VertexPull>& changes, bool release_others) {
  absl::Status changed = session_.run.ChangePulls(changes, release_others);
  if (changed.ok()) NoteChange();
  return changed;
}

absl::StatusOr<v1::Control> SteppingLoop::ChangeControl(
    absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> change) {
  const absl::Status changed = change(session_.control, clock_.Now());
  reporter_.ReportControl(session_);
  if (!changed.ok()) return changed;
  return session_.control.Describe(clock_.Now());
}

absl::Status SteppingLoop::ShowCamera(const v1::Camera& camera, std::string_view token) {
  absl::Status allowed = session_.control.CheckAlone(token, clock_.Now());
  reporter_.ReportControl(session_);
  if (!allowed.ok()) return allowed;
  reporter_.ShowCamera(session_, camera);
  return absl::OkStatus();
}

void SteppingLoop::NoteChange() {
  ++session_.revision;
  reporter_.Report(session_);
}

void SteppingLoop::OfferFrame(absl::Time now) {
  pacer_.FrameMade(now);
  reporter_.OfferFrame(session_, now);
}

}  // namespace phrenic::session
