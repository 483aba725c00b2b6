#include "tests/faults/driver.h"

#include <grpcpp/create_channel.h>

#include <cstdio>

#include "absl/time/clock.h"

namespace phrenic::faults {
namespace {

constexpr char kSession[] = "undisturbed";
constexpr int kStepsPerChange = 5;

// A call with a timeout of two seconds, to detect a server that is gone.
struct Call : grpc::ClientContext {
  explicit Call(const std::string& session, double seconds = 2) {
    AddMetadata("x-session-id", session);
    set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * seconds)));
  }
};

grpc::Status Create(v1::SessionService::Stub& stub, const std::string& session) {
  v1::CreateSessionRequest request;
  request.set_session_id(session);
  request.mutable_source()->set_name("sheet-2d");
  v1::CreateSessionResponse created;
  Call call(session, 30);
  return stub.CreateSession(&call, request, &created);
}

grpc::Status ChangeAt(v1::SessionService::Stub& stub, const std::string& session, std::int64_t tick) {
  v1::UpdateParametersRequest update;
  update.set_session_id(session);
  update.mutable_parameters()->set_breath_force(0.5 + 0.001 * static_cast<double>(tick % 997));
  v1::UpdateParametersResponse updated;
  Call call(session);
  return stub.UpdateParameters(&call, update, &updated);
}

grpc::Status StepTo(v1::SessionService::Stub& stub, const std::string& session, std::int64_t from, std::int64_t to,
                    v1::StepSessionResponse& stepped) {
  v1::StepSessionRequest step;
  step.set_session_id(session);
  step.set_expected_tick(from);
  step.set_ticks(to - from);
  Call call(session);
  return stub.StepSession(&call, step, &stepped);
}

bool ChangesAt(std::int64_t tick) { return tick % (kStepsPerChange * kTicksPerStep) == 0; }

}  // namespace

Oracle::Oracle() {
  auto server = service::Server::Start({});
  if (!server.ok()) return;
  server_ = *std::move(server);
  stub_ = v1::SessionService::NewStub(server_->InProcessChannel());
  if (!Create(*stub_, kSession).ok()) stub_ = nullptr;
  absl::MutexLock lock(&mutex_);
  hashes_[0] = "";
}

std::string Oracle::HashAt(std::int64_t tick) {
  absl::MutexLock lock(&mutex_);
  while (stub_ != nullptr && hashes_.rbegin()->first < tick) {
    const std::int64_t at = hashes_.rbegin()->first;
    v1::StepSessionResponse stepped;
    if (ChangesAt(at) && !ChangeAt(*stub_, kSession, at).ok()) break;
    if (!StepTo(*stub_, kSession, at, at + kTicksPerStep, stepped).ok()) break;
    hashes_[at + kTicksPerStep] = stepped.state_hash();
  }
  const auto found = hashes_.find(tick);
  return found == hashes_.end() ? "no undisturbed run" : found->second;
}

bool Driver::Connect(const std::string& address, bool create) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);  // does not reuse the connection to an earlier server
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 20);
  return Connect(grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments), create);
}

bool Driver::Connect(const std::shared_ptr<grpc::Channel>& channel, bool create) {
  stub_ = v1::SessionService::NewStub(channel);
  tick_ = -1;
  if (!create) return true;
  const grpc::Status status = Create(*stub_, session_);
  error_ = status.error_message();
  return status.ok();
}

std::optional<std::int64_t> Driver::FindTick(double seconds) {
  const absl::Time until = absl::Now() + absl::Seconds(seconds);
  do {
    v1::GetSessionRequest request;
    request.set_session_id(session_);
    v1::GetSessionResponse got;
    Call call(session_);
    const grpc::Status status = stub_->GetSession(&call, request, &got);
    if (status.ok()) {
      seen_ = got.session();
      return tick_ = seen_.tick();
    }
    error_ = status.error_message();
    if (status.error_code() == grpc::StatusCode::NOT_FOUND) return std::nullopt;
    absl::SleepFor(absl::Milliseconds(5));
  } while (absl::Now() < until);
  return std::nullopt;
}

bool Driver::Step() {
  if (tick_ < 0 && !FindTick(0).has_value()) return false;
  // Completes a partly executed call first.
  const std::int64_t end = (tick_ / kTicksPerStep + 1) * kTicksPerStep;
  v1::StepSessionResponse stepped;
  grpc::Status status = ChangesAt(tick_) ? ChangeAt(*stub_, session_, tick_) : grpc::Status::OK;
  if (status.ok()) status = StepTo(*stub_, session_, tick_, end, stepped);
  error_ = status.error_message();
  tick_ = status.ok() ? end : -1;  // the call may have taken effect: FindTick asks
  if (!status.ok()) return false;
  seen_ = stepped.session();
  if (stepped.session().tick() == end && stepped.state_hash() == oracle_.HashAt(end)) return true;
  ++wrong_;
  std::fprintf(stderr, "wrong hash at tick %lld: %s instead of %s\n", static_cast<long long>(end),
               stepped.state_hash().c_str(), oracle_.HashAt(end).c_str());
  return true;
}

}  // namespace phrenic::faults
