#include "tests/cluster/trial/worker.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "absl/time/clock.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::cluster {
namespace {

constexpr char kScene[] = "sheet-2d";
// The pause before a retry, as in the viewer.
constexpr absl::Duration kRetryPause = absl::Milliseconds(100);
constexpr absl::Duration kPause = absl::Milliseconds(30);  // between two steps

struct Timed : grpc::ClientContext {
  Timed(const std::string& session, double seconds) {
    AddMetadata("x-session-id", session);
    set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * seconds)));
  }
};

grpc::Status Make(v1::SessionService::Stub& stub, const std::string& session) {
  v1::CreateSessionRequest request;
  request.set_session_id(session);
  request.mutable_source()->set_name(kScene);
  v1::CreateSessionResponse created;
  Timed call(session, 30);
  return stub.CreateSession(&call, request, &created);
}

// Steps `ticks` ticks and returns the state's hash; empty after an error.
std::string HashAfter(v1::SessionService::Stub& stub, const std::string& session, std::int64_t ticks) {
  v1::StepSessionRequest step;
  step.set_session_id(session);
  step.set_ticks(ticks);
  v1::StepSessionResponse stepped;
  Timed call(session, 120);
  return stub.StepSession(&call, step, &stepped).ok() ? stepped.state_hash() : "";
}

}  // namespace

std::vector<Gap> Worker::GapsSince(absl::Time since) const {
  absl::MutexLock lock(&mutex_);
  std::vector<Gap> gaps;
  std::copy_if(gaps_.begin(), gaps_.end(), std::back_inserter(gaps),
               [since](const Gap& gap) { return gap.end >= since; });
  return gaps;
}

absl::Time Worker::last() const {
  absl::MutexLock lock(&mutex_);
  return last_;
}

void Worker::Record(std::int64_t epoch, double time) {
  constexpr absl::Duration kShortestGap = absl::Milliseconds(100);
  absl::MutexLock lock(&mutex_);
  const absl::Time now = absl::Now();
  const bool moved = epoch != epoch_ && epoch_ != 0 && epoch != 0;
  if (moved || now - last_ > kShortestGap)
    gaps_.push_back({last_, now, moved, moved ? std::max(0.0, time_ - time) : 0});
  last_ = now;
  if (epoch != 0) epoch_ = epoch;
  time_ = time;
}

Stepper::Stepper(const Deployment& deployment, faults::Oracle& oracle, const std::string& session)
    : driver_(oracle, session) {
  made_ = driver_.Connect(deployment.NewChannel(), true);
  if (!made_) std::fprintf(stderr, "%s: %s\n", session.c_str(), driver_.error().c_str());
  if (made_) thread_ = std::thread([this] { Work(); });
}

void Stepper::Stop() {
  stopped_ = true;
  if (thread_.joinable()) thread_.join();
}

void Stepper::Work() {
  while (!stopped_) {
    // After an error, reads the session's tick to measure what was rolled back.
    const bool found = driver_.knows() || driver_.FindTick(0).has_value();
    if (found) Record(driver_.seen().epoch(), driver_.seen().time());
    const bool stepped = found && driver_.Step();
    if (stepped) ++steps_;
    if (stepped) Record(driver_.seen().epoch(), driver_.seen().time());
    absl::SleepFor(stepped ? kPause : kRetryPause);
  }
}

Watcher::Watcher(const Deployment& deployment, std::string session)
    : session_(std::move(session)), channel_(deployment.NewChannel()) {
  const auto stub = v1::SessionService::NewStub(channel_);
  v1::PlaySessionRequest play;
  play.set_session_id(session_);
  v1::PlaySessionResponse played;
  Timed call(session_, 10);
  made_ = Make(*stub, session_).ok() && stub->PlaySession(&call, play, &played).ok();
  if (made_) thread_ = std::thread([this] { Work(); });
}

void Watcher::Stop() {
  stopped_ = true;
  {
    absl::MutexLock lock(&call_mutex_);
    if (call_ != nullptr) call_->TryCancel();
  }
  if (thread_.joinable()) thread_.join();
}

void Watcher::Work() {
  while (!stopped_) {
    WatchOnce();
    absl::SleepFor(kRetryPause);
  }
}

void Watcher::WatchOnce() {
  const auto stub = v1::FrameService::NewStub(channel_);
  Timed call(session_, 3600);
  {
    absl::MutexLock lock(&call_mutex_);
    call_ = &call;
  }
  v1::WatchFramesRequest request;
  request.set_session_id(session_);
  request.set_numbers_only(true);
  request.set_max_fps(30);
  const auto stream = stub->WatchFrames(&call, request);
  v1::WatchFramesResponse event;
  std::int64_t epoch = 0;
  while (!stopped_ && stream->Read(&event)) {
    if (event.has_session()) epoch = event.session().epoch();
    if (event.has_frame()) Record(epoch, event.frame().time());
  }
  call.TryCancel();
  stream->Finish();
  absl::MutexLock lock(&call_mutex_);
  call_ = nullptr;
}

bool Watcher::Right(bool& lost) {
  const auto stub = v1::SessionService::NewStub(channel_);
  v1::PauseSessionRequest pause;
  pause.set_session_id(session_);
  v1::PauseSessionResponse paused;
  grpc::Status status(grpc::StatusCode::UNAVAILABLE, "");
  for (const absl::Time end = absl::Now() + absl::Seconds(20); absl::Now() < end && !status.ok();) {
    Timed call(session_, 5);
    status = stub->PauseSession(&call, pause, &paused);
    if (!status.ok()) absl::SleepFor(kRetryPause);
  }
  lost = !status.ok();
  if (lost) return false;
  const std::string hash = HashAfter(*stub, session_, 1);
  service::ServerOptions options;
  const auto server = service::Server::Start(options);
  if (!server.ok()) return false;
  const auto whole = v1::SessionService::NewStub((*server)->InProcessChannel());
  return Make(*whole, session_).ok() && !hash.empty() &&
         hash == HashAfter(*whole, session_, paused.session().tick() + 1);
}

}  // namespace phrenic::cluster
