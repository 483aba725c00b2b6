#include "server/daemon/serve.h"

#include <signal.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/net/address.h"
#include "server/service/net/listen.h"
#include "server/service/server.h"

namespace phrenic::daemon {
namespace {

constexpr int kMostToRestoreOne = 60'000'000;  // [us] that a service manager waits for a session to be restored

// Of what others can reach: that nothing is encrypted, and that nobody is asked who they are.
void WarnOfReach(const service::ServerOptions& options) {
  const bool asked = options.accounts.used() || !options.tls.client_ca.empty();
  for (const std::string& address : {options.listen, options.web}) {
    const auto parts = service::ParseAddress(address);
    if (!parts.ok() || service::IsLoopback(*parts)) continue;
    if (!options.tls.used()) spdlog::warn("{}: anybody on the way can read and change everything", address);
    if (!asked) spdlog::warn("{}: whoever reaches it may do everything; give --tokens FILE", address);
  }
}

// The address as it can be called from this machine: with the port that was chosen.
std::string Reachable(const std::string& address, int port) {
  std::string host = service::ParseAddress(address)->host;
  if (host == "0.0.0.0" || host == "::") host = "127.0.0.1";
  if (host.find(':') != std::string::npos) host = absl::StrCat("[", host, "]");
  return absl::StrCat(host, ":", port);
}

// The scene's name, or with the next number where a session of that name could not be restored.
std::string FirstSession(const service::Server& server, const std::string& scene) {
  std::string id = scene;
  for (int i = 2; server.lost().contains(id); ++i) id = absl::StrCat(scene, "-", i);
  return id;
}

// A session of the scene, playing.
grpc::Status StartScene(service::Server& server, const std::string& scene) {
  const std::string id = FirstSession(server, scene);
  spdlog::info("building the first scene: session {}", id);
  const auto stub = v1::SessionService::NewStub(server.InProcessChannel());
  v1::CreateSessionRequest request;
  request.set_session_id(id);
  request.mutable_source()->set_name(scene);
  v1::CreateSessionResponse created;
  grpc::ClientContext creating, playing;
  grpc::Status status = stub->CreateSession(&creating, request, &created);
  if (status.error_code() == grpc::StatusCode::ALREADY_EXISTS) return grpc::Status::OK;  // it goes on as it was
  if (!status.ok()) return status;
  v1::PlaySessionRequest play;
  play.set_session_id(id);
  v1::PlaySessionResponse played;
  return stub->PlaySession(&playing, play, &played);
}

// Signals that end the server, held back from every thread that is started after this.
sigset_t HoldSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

// Tells a service manager that has started this program; without one, nothing (sd_notify(3)).
void TellManager(const std::string& state) { sd_notify(0, state.c_str()); }

// Null: why is in the log.
std::unique_ptr<service::Server> Start(const Flags& flags) {
  service::ServerOptions options = OptionsOf(flags);
  int restored = 0;
  options.restoring = [&restored](const std::string&) {
    spdlog::info("restoring session {}", ++restored);
    TellManager(absl::StrCat("STATUS=restoring session ", restored, "\nEXTEND_TIMEOUT_USEC=", kMostToRestoreOne));
  };
  auto server = service::Server::Start(options);
  if (!server.ok()) {
    spdlog::error("{}", std::string(server.status().message()));
    return nullptr;
  }
  for (const auto& [what, why] : (*server)->lost()) {
    spdlog::warn("{} could not be restored and stays in the store until it is deleted: {}", what,
                 std::string(why.message()));
  }
  WarnOfReach(options);
  return *std::move(server);
}

void SayWhere(const service::ServerOptions& options, const service::Server& server) {
  const char* scheme = options.tls.used() ? "https" : "http";
  if (!options.listen.empty()) std::printf("gRPC:   %s\n", Reachable(options.listen, server.port()).c_str());
  if (!options.web.empty()) {
    std::printf("Viewer: %s://%s/\n", scheme, Reachable(options.web, server.web_port()).c_str());
  }
  std::fflush(stdout);
}

// Work that does not end, a scene of millions of vertices that is being built, say, is broken off: what was saved is on
// disk.
void EndWithin(double seconds) {
  std::thread([seconds] {
    absl::SleepFor(absl::Seconds(seconds));
    spdlog::error("work did not end within {} s (--stop-seconds) and was broken off", seconds);
    std::_Exit(kFailed);
  }).detach();
}

}  // namespace

int Serve(const Flags& flags) {
  const sigset_t signals = HoldSignals();
  service::AllowManyFiles();
  const auto server = Start(flags);
  if (server == nullptr) return kFailed;
  if (flags.start != "none") {
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // nothing to lose yet: a signal ends the program at once
    const grpc::Status status = StartScene(*server, flags.start);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    if (!status.ok()) {
      spdlog::error("--start {}: {}", flags.start, status.error_message());
      return kFailed;
    }
  }
  SayWhere(flags.options, *server);
  TellManager("READY=1\nSTATUS=");
  int signal_number = 0;
  sigwait(&signals, &signal_number);
  spdlog::info("stopping");
  TellManager("STOPPING=1");
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // a second one ends the program at once
  signal(signal_number == SIGTERM ? SIGINT : SIGTERM, SIG_DFL);
  EndWithin(flags.stop_seconds);
  server->Shutdown();
  return kOk;
}

}  // namespace phrenic::daemon
