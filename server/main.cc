// phrenicd: flags -> options -> serve until a signal comes.
#include <signal.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/address.h"
#include "server/service/server.h"
#include "server/store/check.h"

namespace phrenic {
namespace {

constexpr int kOk = 0, kFailed = 1, kUsage = 2;

struct Flags {
  service::ServerOptions options;
  std::string start = "thorax";
};

// systemd's StateDirectory, else the user's.
std::string DefaultStore() {
  const auto from = [](const char* variable, const char* below) {
    const char* folder = std::getenv(variable);
    return folder == nullptr || *folder == '\0' ? std::string() : absl::StrCat(folder, below);
  };
  for (const auto& [variable, below] :
       {std::pair("STATE_DIRECTORY", ""), {"XDG_STATE_HOME", "/phrenic"}, {"HOME", "/.local/state/phrenic"}}) {
    if (std::string folder = from(variable, below); !folder.empty()) return folder;
  }
  return "none";
}

void AddFlags(CLI::App& app, Flags& flags) {
  service::ServerOptions& options = flags.options;
  options.listen = "127.0.0.1:50051";
  options.web = "127.0.0.1:8080";
  options.store_dir = DefaultStore();
  app.add_option("--listen", options.listen, "HOST:PORT of gRPC")->capture_default_str();
  app.add_option("--web", options.web, "HOST:PORT of the viewer and gRPC-web")->capture_default_str();
  app.add_option("--data", options.data_dir, "Folder of surface files; scenes of your own in its folder scenes/");
  app.add_option("--scenes", options.scenes_dir, "Folder of the shipped scenes")->capture_default_str();
  app.add_option("--spool", options.spool_dir,
                 "Folder on a disk with room, for exports and uploads; nothing stays in it")
      ->capture_default_str();
  app.add_option("--keep-exports", options.limits.export_minutes, "Minutes that an export waits to be downloaded")
      ->check(CLI::Range(1, 10080))
      ->capture_default_str();
  app.add_option("--store", options.store_dir,
                 "Folder that sessions are saved in, so that they go on after the server ended; none: nowhere")
      ->capture_default_str();
  app.add_option("--web-root", options.web_root, "Folder of the built viewer")->capture_default_str();
  app.add_option("--start", flags.start, "Scene to start and play, or none")->capture_default_str();
  app.add_option("--allow-origin", options.allowed_origins, "Web pages that may call, as https://example.org");
  app.add_option("--max-sessions", options.limits.sessions, "Sessions at once")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--max-viewers", options.limits.viewers, "Viewers of one session")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
}

void WarnIfReachable(const std::string& address) {
  const auto parts = service::ParseAddress(address);
  if (!parts.ok() || service::IsLoopback(*parts)) return;
  spdlog::warn(
      "{} can be reached from other machines, and nothing is encrypted or asked for a password: use it in "
      "networks that you trust",
      address);
}

// The address as it can be called from this machine: with the port that was chosen.
std::string Reachable(const std::string& address, int port) {
  std::string host = service::ParseAddress(address)->host;
  if (host == "0.0.0.0" || host == "::") host = "127.0.0.1";
  if (host.find(':') != std::string::npos) host = absl::StrCat("[", host, "]");
  return absl::StrCat(host, ":", port);
}

// A session of the scene, with the scene's name, playing.
grpc::Status StartScene(service::Server& server, const std::string& scene) {
  const auto stub = v1::SessionService::NewStub(server.InProcessChannel());
  v1::CreateSessionRequest request;
  request.set_session_id(scene);
  request.mutable_source()->set_name(scene);
  v1::CreateSessionResponse created;
  grpc::ClientContext creating, playing;
  grpc::Status status = stub->CreateSession(&creating, request, &created);
  if (status.error_code() == grpc::StatusCode::ALREADY_EXISTS) return grpc::Status::OK;  // it goes on as it was
  if (!status.ok()) return status;
  v1::PlaySessionRequest play;
  play.set_session_id(scene);
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

int Serve(const Flags& flags) {
  const sigset_t signals = HoldSignals();
  service::ServerOptions chosen = flags.options;
  if (chosen.store_dir == "none") chosen.store_dir.clear();
  chosen.restoring = [](const std::string& id) { spdlog::info("restoring the session {}", id); };
  auto server = service::Server::Start(chosen);
  if (!server.ok()) {
    spdlog::error("{}", std::string(server.status().message()));
    return kFailed;
  }
  for (const auto& [id, reason] : (*server)->lost()) {
    spdlog::warn("the session {} stays in the store: {}", id, std::string(reason.message()));
  }
  WarnIfReachable(flags.options.listen);
  WarnIfReachable(flags.options.web);
  if (flags.start != "none") {
    spdlog::info("building the scene {}", flags.start);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // nothing to lose yet: a signal ends the program at once
    const grpc::Status status = StartScene(**server, flags.start);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    if (!status.ok()) {
      spdlog::error("--start {}: {}", flags.start, status.error_message());
      return kFailed;
    }
  }
  const service::ServerOptions& options = flags.options;
  if (!options.listen.empty()) std::printf("gRPC:   %s\n", Reachable(options.listen, (*server)->port()).c_str());
  if (!options.web.empty()) std::printf("Viewer: http://%s/\n", Reachable(options.web, (*server)->web_port()).c_str());
  std::fflush(stdout);
  int signal_number = 0;
  sigwait(&signals, &signal_number);
  spdlog::info("stopping");
  (*server)->Shutdown();
  return kOk;
}

int Check(const std::string& folder) {
  const auto checked = store::CheckStore(folder);
  if (!checked.ok()) {
    spdlog::error("{}", std::string(checked.status().message()));
    return kFailed;
  }
  std::fputs(store::Describe(folder, *checked).c_str(), stdout);
  return checked->whole() ? kOk : kFailed;
}

int Main(int argc, char** argv) {
  setenv("GRPC_VERBOSITY", "NONE", 0);  // what matters of it comes as a status
  spdlog::set_default_logger(spdlog::stderr_color_mt("phrenicd"));
  CLI::App app("phrenicd: simulates the breathing diaphragm and serves it to viewers and programs.");
  Flags flags;
  AddFlags(app, flags);
  std::string checked;
  CLI::App* check = app.add_subcommand("check", "Say what is in a store, and whether it is whole; changes nothing");
  check->add_option("DIR", checked, "the store's folder")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  if (check->parsed()) return Check(checked);
  return Serve(flags);
}

}  // namespace
}  // namespace phrenic

int main(int argc, char** argv) { return phrenic::Main(argc, argv); }
