#include "server/session/session.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "google/protobuf/util/time_util.h"

namespace phrenic::session {
namespace {

// Between two looks of a waiting call at whether its caller is still there.
constexpr absl::Duration kLook = absl::Milliseconds(50);

v1::Session FirstStatus(const std::string& id, const Model& model, const SessionOrigin& origin, absl::Time now) {
  v1::Session status;
  status.set_id(id);
  status.set_epoch(origin.epoch);
  status.set_scene(model.scene.name());
  status.set_scene_title(model.scene.title());
  *status.mutable_create_time() =
      origin.saved_moment.has_value()
          ? origin.saved_moment->session().create_time()
          : google::protobuf::util::TimeUtil::NanosecondsToTimestamp(absl::ToUnixNanos(now));
  status.set_temporary(origin.temporary);
  if (!origin.saved_moment.has_value()) return status;
  status.set_temporary(origin.saved_moment->session().temporary());
  status.set_carried_over(origin.saved_moment->session().carried_over());
  return status;
}

RunningSession StartOf(const std::shared_ptr<const Model>& model, Fork start, const SessionOrigin& origin) {
  RunningSession session{.run = Run(model, std::move(start.parameters), std::move(start.state)),
                         .control = origin.control,
                         .stable_step = start.stable_step};
  if (origin.saved_moment.has_value()) session.Restore(*origin.saved_moment);
  return session;
}

std::vector<std::string> Warnings(const v1::Parameters& parameters, double stable_step) {
  if (parameters.time_step() <= stable_step) return {};
  return {
      absl::StrFormat("time_step: %.3g s is above %.3g s, the largest stable step at the present stiffness, and "
                      "the session will probably diverge; set it to %.2g s or less",
                      parameters.time_step(), stable_step, 0.9 * stable_step)};
}

}  // namespace

Session::Session(std::string id, std::shared_ptr<const Model> model, Fork start, const Clock& clock,
                 const Limits& limits, Origin origin)
    : id_(std::move(id)),
      model_(std::move(model)),
      surfaces_(std::move(origin.surfaces)),
      clock_(clock),
      publisher_(model_, clock, limits.viewers),
      sampler_(model_, clock),
      attended_(absl::ToUnixNanos(clock.Now())),
      board_(FirstStatus(id_, *model_, origin, clock.Now())),
      saver_(std::move(origin.journal), clock, origin.epoch > 0),
      reporter_(clock, board_, saver_, publisher_, sampler_),
      loop_(StartOf(model_, std::move(start), origin), limits.session_cpu, clock, reporter_, origin.held) {}

Session::~Session() { Stop(absl::UnavailableError(absl::StrCat("session ", id_, " has ended"))); }

v1::Session Session::Saved(store::Durability durability) {
  const absl::Status saved = saver_.Flush(durability);
  v1::Session now = status();
  if (!saved.ok()) publisher_.Announce(now);  // viewers got the status before the store failed
  return now;
}

absl::Status Session::CallToChange(std::string_view token, absl::FunctionRef<absl::Status()> act) {
  if (absl::Status lease = saver_.CheckLease(); !lease.ok()) return lease;
  return loop_.CallAs(token, act);
}

absl::StatusOr<v1::Session> Session::Change(std::string_view token, absl::FunctionRef<absl::Status()> act) {
  if (absl::Status changed = CallToChange(token, act); !changed.ok()) return changed;
  return Saved();
}

absl::StatusOr<v1::Session> Session::Play(std::optional<double> speed, bool as_fast_as_possible, double until,
                                          std::string_view token, std::weak_ptr<const ReachedTime> leader) {
  return Play(PlayRequest{speed, as_fast_as_possible, until, std::move(leader)}, token);
}

absl::StatusOr<v1::Session> Session::Play(const PlayRequest& request, std::string_view token) {
  return Change(token, [&] { return loop_.Play(request); });
}

absl::StatusOr<v1::Session> Session::Pause(std::string_view token) {
  return Change(token, [this] {
    loop_.Pause("the session was paused while it was being stepped");
    return absl::OkStatus();
  });
}

absl::StatusOr<Session::Stepped> Session::Step(std::int64_t ticks, std::optional<std::int64_t> expected_tick,
                                               absl::FunctionRef<bool()> cancelled, std::string_view token) {
  auto job = std::make_shared<StepJob>();
  job->left = ticks;
  absl::Status started = CallToChange(token, [&] { return loop_.StartJob(job, expected_tick); });
  if (!started.ok()) return started;
  while (!job->done.WaitForNotificationWithTimeout(kLook)) {
    if (!cancelled()) continue;
    absl::Status called = loop_.Call([&] {
      loop_.CancelJob(*job, absl::CancelledError("the caller went away while the session was being stepped"));
    });
    if (!called.ok()) return called;
  }
  const std::string not_saved = Saved(store::Durability::kProcess).not_saved();
  if (!job->status.ok()) return std::move(job->status);
  job->result.session.set_not_saved(not_saved);
  return std::move(job->result);
}

absl::StatusOr<v1::Session> Session::Reset(std::string_view token) {
  return Change(token, [this] {
    loop_.Reset();
    return absl::OkStatus();
  });
}

absl::StatusOr<Session::Updated> Session::Update(const v1::Parameters& changes,
                                                 std::optional<std::int64_t> expected_revision,
                                                 std::optional<std::int64_t> at_tick, std::string_view token) {
  absl::MutexLock one_at_a_time(&update_mutex_);
  const v1::Session before = status();
  v1::Parameters parameters = before.parameters();
  parameters.MergeFrom(changes);
  // On this thread, as it takes a while.
  const double stable_step = StableStepFor(*model_, parameters, before.parameters(), before.largest_stable_step());
  auto saved = Change(token, [&] { return loop_.Update(changes, stable_step, expected_revision, at_tick); });
  if (!saved.ok()) return saved.status();
  return Updated{*std::move(saved), Warnings(parameters, stable_step)};
}

absl::StatusOr<v1::Session> Session::Pull(const PullList& pulls, bool release_others, std::string_view token) {
  const auto changes = FindPulls(*model_, pulls, "pulls");
  if (!changes.ok()) return changes.status();
  return Change(token, [&] { return loop_.ChangePulls(*changes, release_others); });
}

void Session::Release() {
  (void)loop_.Call([this] { loop_.Release(); });
}

void Session::Rest() {
  (void)loop_.Call([this] { loop_.Pause("the session was paused, because it had no viewer for too long"); });
}

void Session::AnnounceNotSaved() {
  const v1::Session now = status();
  if (now.not_saved() == announced_not_saved_) return;
  announced_not_saved_ = now.not_saved();
  publisher_.Announce(now);
}

absl::Status Session::CheckControl(std::string_view token) {
  return CallToChange(token, [] { return absl::OkStatus(); });
}

absl::Status Session::CheckSoleControl(std::string_view token) {
  absl::StatusOr<v1::Control> control;
  const auto check = [&](ControlBook& book, absl::Time now) { return book.CheckAlone(token, now); };
  absl::Status called = loop_.Call([&] { control = loop_.ChangeControl(check); });
  return called.ok() ? control.status() : called;
}

absl::StatusOr<v1::Control> Session::ChangeControl(
    absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> act) {
  absl::StatusOr<v1::Control> control;
  if (absl::Status lease = saver_.CheckLease(); !lease.ok()) return lease;
  absl::Status called = loop_.Call([&] { control = loop_.ChangeControl(act); });
  if (!called.ok()) return called;
  if (!control.ok()) return control;
  Saved();
  if (absl::Status acknowledged = Acknowledge(); !acknowledged.ok()) return acknowledged;
  return control;
}

absl::Status Session::ShowCamera(const v1::Camera& camera, std::string_view token) {
  absl::Status shown;
  absl::Status called = loop_.Call([&] { shown = loop_.ShowCamera(camera, token); });
  return called.ok() ? shown : called;
}

absl::StatusOr<Fork> Session::MakeFork() {
  absl::StatusOr<Fork> fork;
  absl::Status called = loop_.Call([&] { fork = loop_.MakeFork(); });
  if (!called.ok()) return called;
  return fork;
}

absl::StatusOr<PresentState> Session::ReadState() {
  absl::StatusOr<PresentState> present;
  absl::Status called = loop_.Call([&] { present = loop_.ReadState(); });
  if (!called.ok()) return called;
  return present;
}

void Session::Stop(const absl::Status& reason) {
  if (!loop_.Stop(reason)) return;
  publisher_.Close(reason);
  sampler_.Close(reason);
}

}  // namespace phrenic::session
