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
#include "server/service/memory_trimmer.h"
#include "server/service/net/address.h"
#include "server/service/net/listen.h"
#include "server/service/server.h"

namespace phrenic::daemon {
namespace {

constexpr int kRestoreTimeout = 60'000'000;  // [us] for one session, told to the service manager

// Logs a warning for each address that other machines reach without TLS, without authentication or without a guard.
void WarnIfExposed(const service::ServerOptions& options) {
  const bool authenticated = options.accounts.used() || !options.tls.client_ca.empty();
  for (const std::string& address : {options.listen, options.web}) {
    const auto parts = service::ParseAddress(address);
    if (!parts.ok() || service::IsLoopback(*parts)) continue;
    if (!options.tls.used())
      spdlog::warn("{}: not encrypted; traffic can be read and modified on the network", address);
    if (!authenticated)
      spdlog::warn("{}: no authentication; every client may do everything; pass --tokens FILE", address);
    if (options.unguarded_listen && address == options.listen)
      spdlog::warn("{}: not guarded; one client without an account can overload gRPC; put nginx in front", address);
  }
}

// Returns the address at which this machine reaches a listen address, with the actual port.
std::string Reachable(const std::string& address, int port) {
  std::string host = service::ParseAddress(address)->host;
  if (host == "0.0.0.0" || host == "::") host = "127.0.0.1";
  if (host.find(':') != std::string::npos) host = absl::StrCat("[", host, "]");
  return absl::StrCat(host, ":", port);
}

// Returns the scene's name, with a number if a session of that name could not be restored.
std::string FirstSession(const service::Server& server, const std::string& scene) {
  std::string id = scene;
  for (int i = 2; server.lost().contains(id); ++i) id = absl::StrCat(scene, "-", i);
  return id;
}

// Creates a session of the scene and plays it. Keeps a restored session of that name as it is.
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
  if (status.error_code() == grpc::StatusCode::ALREADY_EXISTS) return grpc::Status::OK;  // restored from the store
  if (!status.ok()) return status;
  v1::PlaySessionRequest play;
  play.set_session_id(id);
  v1::PlaySessionResponse played;
  return stub->PlaySession(&playing, play, &played);
}

// Blocks SIGINT and SIGTERM in this thread and in the threads that it starts, so that sigwait receives them. Ignores
// SIGPIPE.
sigset_t BlockSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

// Notifies the service manager, if there is one (sd_notify(3)).
void NotifyManager(const std::string& state) { sd_notify(0, state.c_str()); }

// Returns null after an error, which is logged.
std::unique_ptr<service::Server> Start(const Flags& flags) {
  service::ServerOptions options = OptionsOf(flags);
  int restored = 0;
  options.restoring = [&restored](const std::string&) {
    spdlog::info("restoring session {}", ++restored);
    NotifyManager(absl::StrCat("STATUS=restoring session ", restored, "\nEXTEND_TIMEOUT_USEC=", kRestoreTimeout));
  };
  auto server = service::Server::Start(options);
  if (!server.ok()) {
    spdlog::error("{}", std::string(server.status().message()));
    return nullptr;
  }
  for (const auto& [name, error] : (*server)->lost()) {
    spdlog::warn("{} could not be restored and stays in the store until it is deleted: {}", name,
                 std::string(error.message()));
  }
  WarnIfExposed(options);
  return *std::move(server);
}

void PrintAddresses(const service::ServerOptions& options, const service::Server& server) {
  const char* scheme = options.tls.used() ? "https" : "http";
  if (!options.listen.empty()) std::printf("gRPC:   %s\n", Reachable(options.listen, server.port()).c_str());
  if (!options.web.empty()) {
    std::printf("Viewer: %s://%s/\n", scheme, Reachable(options.web, server.web_port()).c_str());
  }
  std::fflush(stdout);
}

// Aborts the process after a time, because work such as compiling a large scene cannot be cancelled. Saved state is on
// disk.
void ExitAfter(double seconds) {
  std::thread([seconds] {
    absl::SleepFor(absl::Seconds(seconds));
    spdlog::error("shutdown did not finish within {} s (--stop-seconds); the process is aborted", seconds);
    std::_Exit(kFailed);
  }).detach();
}

}  // namespace

int Serve(const Flags& flags) {
  service::LimitFreeMemory();
  const sigset_t signals = BlockSignals();
  service::RaiseFileLimit();
  const auto server = Start(flags);
  if (server == nullptr) return kFailed;
  if (flags.start != "none") {
    pthread_sigmask(SIG_UNBLOCK, &signals,
                    nullptr);  // there is no state to save yet, so a signal ends the process at once
    const grpc::Status status = StartScene(*server, flags.start);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    if (!status.ok()) {
      spdlog::error("--start {}: {}", flags.start, status.error_message());
      return kFailed;
    }
  }
  PrintAddresses(flags.options, *server);
  NotifyManager("READY=1\nSTATUS=");
  int signal_number = 0;
  sigwait(&signals, &signal_number);
  spdlog::info("stopping");
  NotifyManager("STOPPING=1");
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // a second signal ends the process at once
  signal(signal_number == SIGTERM ? SIGINT : SIGTERM, SIG_DFL);
  ExitAfter(flags.stop_seconds);
  server->Shutdown();
  return kOk;
}

}  // namespace phrenic::daemon
