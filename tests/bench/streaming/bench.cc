#include <grpcpp/create_channel.h>

#include <chrono>
#include <thread>

#include "tests/bench/streaming/parts.h"

namespace phrenic::bench {
namespace {

constexpr double kLearning = 8;  // two quiet breaths, in which the shapes of CODEC_BASIS are seen [s]
constexpr double kSlowly = 0.1;  // of real time: as many frames, and the processor is left to who sends them

grpc::Status Call(const grpc::Status& status) {
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.error_message().c_str());
  return status;
}

double Wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

Bench::Bench(const Settings& settings, std::unique_ptr<ServerProcess> server)
    : settings_(settings),
      server_(std::move(server)),
      sessions_(
          v1::SessionService::NewStub(grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials()))) {}

absl::StatusOr<std::unique_ptr<Bench>> Bench::Start(const Settings& settings) {
  std::vector<std::string> environment;
  if (!settings.program.empty()) environment.push_back("PHRENIC_SERVER_PROGRAM=" + settings.program);
  auto server = std::make_unique<ServerProcess>(
      PHRENIC_BINARY_DIR "/streaming_bench.said",
      std::vector<std::string>{"--store", "none", "--max-viewers", "1000", "--max-viewers-in-all", "1000",
                               "--max-connections", "4000", "--max-calls", "4000"},
      environment);
  if (absl::Status status = server->Start(); !status.ok()) return status;
  std::unique_ptr<Bench> bench(new Bench(settings, std::move(server)));
  v1::CreateSessionRequest request;
  request.set_session_id(kSession);
  request.mutable_source()->set_name(settings.scene);
  v1::CreateSessionResponse response;
  grpc::ClientContext context;
  const grpc::Status created = bench->sessions_->CreateSession(&context, request, &response);
  if (!created.ok()) return absl::UnavailableError(created.error_message());
  bench->Play(1);
  const auto learning = WatchOverGrpc(bench->server().address(), {.codec = v1::CODEC_BASIS});
  bench->Sleep(std::min(kLearning, 4 * settings.seconds));
  bench->Play(kSlowly);
  return bench;
}

void Bench::Play(double speed) {
  v1::PlaySessionRequest request;
  request.set_session_id(kSession);
  request.set_as_fast_as_possible(speed == 0);
  if (speed > 0) request.set_speed(speed);
  v1::PlaySessionResponse response;
  grpc::ClientContext context;
  Call(sessions_->PlaySession(&context, request, &response));
}

v1::Session Bench::Session() {
  v1::GetSessionRequest request;
  request.set_session_id(kSession);
  v1::GetSessionResponse response;
  grpc::ClientContext context;
  Call(sessions_->GetSession(&context, request, &response));
  return response.session();
}

void Bench::Sleep(double seconds) const { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

Sight Watch(Bench& bench, Viewers& viewers, double seconds, Cost* cost) {
  viewers.seen().Take();
  const double wall = Wall(), all = bench.server().Cpu(), stepping = bench.server().Cpu("stepping");
  bench.Sleep(seconds);
  Sight sight = viewers.seen().Take();
  cost->wall = Wall() - wall;
  cost->stepping = bench.server().Cpu("stepping") - stepping;
  cost->sending = bench.server().Cpu() - all - cost->stepping;
  return sight;
}

std::string Verdict(bool met, const std::string& aim) { return (met ? "met: " : "MISSED: ") + aim; }

}  // namespace phrenic::bench
