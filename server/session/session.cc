#include "server/session/session.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "google/protobuf/util/time_util.h"

namespace phrenic::session {
namespace {

// How long a waiting call goes on before it looks again whether its caller is still there.
constexpr absl::Duration kLook = absl::Milliseconds(50);

}  // namespace

Session::Session(std::string id, std::shared_ptr<const Model> model, Fork start, const stream::Clock& clock,
                 const Limits& limits, Origin origin)
    : id_(std::move(id)),
      epoch_(origin.epoch),
      model_(std::move(model)),
      surfaces_(std::move(origin.surfaces)),
      clock_(clock),
      publisher_(model_, clock, limits.viewers),
      attended_(absl::ToUnixNanos(clock.Now())),
      run_(model_, std::move(start.parameters), std::move(start.state)),
      share_(limits.session_cpu),
      stable_step_(start.stable_step),
      control_(std::move(origin.control)),
      journal_(std::move(origin.journal)) {
  {
    absl::MutexLock lock(&mutex_);
    status_.set_id(id_);
    status_.set_epoch(epoch_);
    status_.set_scene(model_->scene.name());
    status_.set_scene_title(model_->scene.title());
    *status_.mutable_create_time() =
        google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(clock.Now()));
  }
  if (origin.told.has_value()) GoOn(*origin.told);
  if (state_ == v1::SESSION_STATE_PLAYING) *reached_ = run_.state().time;
  pacer_.Start(clock.Now(), run_.state().time, speed_);
  meter_.Start(clock.Now(), run_.state().tick, run_.state().time);
  Tell();
  OfferFrame(clock.Now());
  thread_ = std::thread([this] { Loop(); });
}

Session::~Session() {
  Stop(absl::UnavailableError(absl::StrCat("session ", id_, " has ended")));
  thread_.join();
}

v1::Session Session::status() const {
  v1::Session status;
  {
    absl::MutexLock lock(&mutex_);
    status = status_;
  }
  status.set_viewers(publisher_.viewers());
  WriteNotSaved(status);
  return status;
}

absl::Status Session::Ask(absl::FunctionRef<void()> act) {
  bool ran = false;
  auto done = std::make_shared<absl::Notification>();
  {
    absl::MutexLock lock(&mutex_);
    if (stopped_.has_value()) return *stopped_;
    commands_.push_back({.act =
                             [&] {
                               act();
                               ran = true;
                             },
                         .done = done});
    called_ = true;
  }
  done->WaitForNotification();
  if (ran) return absl::OkStatus();
  absl::MutexLock lock(&mutex_);
  return stopped_.value_or(absl::InternalError("the stepping thread refused a call"));
}

absl::StatusOr<v1::Session> Session::Play(std::optional<double> speed, bool as_fast_as_possible, double until,
                                          std::string_view token, std::weak_ptr<const ReachedTime> leader) {
  auto played = AskAs(token, [&] { return StartPlaying(speed, as_fast_as_possible, until, leader); });
  if (!played.ok()) return played;
  return Saved();
}

absl::StatusOr<v1::Session> Session::Pause(std::string_view token) {
  auto paused = AskAs(token, [&] {
    EndJob(absl::AbortedError("the session was paused while it was being stepped"));
    if (state_ == v1::SESSION_STATE_PLAYING) Halt(v1::SESSION_STATE_PAUSED);
    return absl::OkStatus();
  });
  if (!paused.ok()) return paused;
  return Saved();
}

absl::StatusOr<Session::Stepped> Session::Step(std::int64_t ticks, std::optional<std::int64_t> expected_tick,
                                               absl::FunctionRef<bool()> cancelled, std::string_view token) {
  auto job = std::make_shared<StepJob>();
  job->left = ticks;
  if (auto started = AskAs(token, [&] { return StartJob(job, expected_tick); }); !started.ok()) return started;
  while (!job->done.WaitForNotificationWithTimeout(kLook)) {
    if (!cancelled()) continue;
    auto asked = Ask([&] {
      if (job_ == job) EndJob(absl::CancelledError("the caller went away while the session was being stepped"));
    });
    if (!asked.ok()) return asked;
  }
  if (!job->status.ok()) return std::move(job->status);
  return std::move(job->result);
}

absl::StatusOr<v1::Session> Session::Reset(std::string_view token) {
  auto reset = AskAs(token, [&] {
    EndJob(absl::AbortedError("the session was reset while it was being stepped"));
    run_.Reset();
    from_start_ = true;
    waiting_updates_.clear();
    framed_tick_ = -1;
    state_ = v1::SESSION_STATE_PAUSED;
    ++revision_;
    Halt(v1::SESSION_STATE_PAUSED);
    return absl::OkStatus();
  });
  if (!reset.ok()) return reset;
  return Saved();
}

absl::StatusOr<v1::Session> Session::Pull(const PullList& pulls, bool release_others, std::string_view token) {
  const auto changes = FindPulls(*model_, pulls, "pulls");
  if (!changes.ok()) return changes.status();
  auto pulled = AskAs(token, [&] {
    absl::Status changed = run_.ChangePulls(*changes, release_others);
    if (changed.ok()) Changed();
    return changed;
  });
  if (!pulled.ok()) return pulled;
  return Saved();
}

absl::StatusOr<Session::Fork> Session::MakeFork() {
  absl::StatusOr<Fork> fork = absl::UnknownError("");
  auto asked = Ask([&] {
    const absl::Status good = CheckNotDiverged();
    if (good.ok()) {
      fork = Fork{run_.parameters(), run_.state(), stable_step_};
    } else {
      fork = good;
    }
  });
  if (!asked.ok()) return asked;
  return fork;
}

void Session::Stop(const absl::Status& reason) {
  {
    absl::MutexLock lock(&mutex_);
    if (stopped_.has_value()) return;
    stopped_ = reason;
    called_ = true;
  }
  publisher_.Close(reason);
}

}  // namespace phrenic::session
