// Measures a cluster on this machine with many small sessions and viewers: how evenly sessions are distributed over the
// servers, how fast one client steps them all, and what a viewer's frame costs, directly and through nginx.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "tests/cluster/scale/viewers.h"
#include "tests/cluster/trial/deployment.h"

namespace phrenic::cluster {
namespace {

constexpr char kScene[] = "sheet-2d";
constexpr int kCallers = 32;  // concurrent calls of the client
constexpr int kTicksPerCall = 10;
constexpr int kViewersPerSession = 25;

struct Options {
  int servers = 4, sessions = 1000, viewers = 500;
  double seconds = 10;
};

struct Call : grpc::ClientContext {
  explicit Call(const std::string& session) {
    AddMetadata("x-session-id", session);
    set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
  }
};

// CPU time of the parts of a cluster [s].
struct Cpu {
  double servers = 0, nginx = 0, redis = 0;
};

double Quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

class Scale {
 public:
  explicit Scale(const Options& options) : options_(options) {}

  bool Run() {
    const absl::Status started =
        deployment_.Start(options_.servers, {"--max-sessions-of-user", "1000", "--max-requests", "1000000"});
    if (!started.ok()) return Fail(std::string(started.message()));
    return MakeSessions() && CountSessions() && Step() && WatchBothWays();
  }

 private:
  static bool Fail(const std::string& problem) {
    std::fprintf(stderr, "cluster_scale: %s\n", problem.c_str());
    return false;
  }

  // Calls act(stub, i) for every i below `count` from kCallers threads, each with its own connection. Returns the first
  // error.
  template <typename Act>
  grpc::Status ForEach(int count, const Act& act) {
    std::vector<grpc::Status> errors(kCallers);
    std::vector<std::thread> callers;
    callers.reserve(kCallers);
    for (int c = 0; c < kCallers; ++c) {
      callers.emplace_back([&, c] {
        const auto stub = v1::SessionService::NewStub(deployment_.NewChannel());
        for (int i = c; i < count && errors[c].ok(); i += kCallers) errors[c] = act(*stub, i);
      });
    }
    for (std::thread& caller : callers) caller.join();
    const auto bad = std::find_if(errors.begin(), errors.end(), [](const grpc::Status& each) { return !each.ok(); });
    return bad == errors.end() ? grpc::Status::OK : *bad;
  }

  static std::string NameOf(int session) { return absl::StrCat("small-", session); }

  static grpc::Status Make(v1::SessionService::Stub& stub, const std::string& session) {
    v1::CreateSessionRequest request;
    request.set_session_id(session);
    request.mutable_source()->set_name(kScene);
    v1::CreateSessionResponse created;
    Call call(session);
    return stub.CreateSession(&call, request, &created);
  }

  static grpc::Status Play(v1::SessionService::Stub& stub, const std::string& session) {
    v1::PlaySessionRequest play;
    play.set_session_id(session);
    v1::PlaySessionResponse played;
    Call call(session);
    return stub.PlaySession(&call, play, &played);
  }

  bool MakeSessions() {
    const absl::Time begin = absl::Now();
    const grpc::Status made =
        ForEach(options_.sessions, [](v1::SessionService::Stub& stub, int i) { return Make(stub, NameOf(i)); });
    if (!made.ok()) return Fail(absl::StrCat("the sessions could not be created: ", made.error_message()));
    std::printf("%d sessions of %s on %d servers, created in %.1f s\n", options_.sessions, kScene, options_.servers,
                absl::ToDoubleSeconds(absl::Now() - begin));
    return true;
  }

  bool CountSessions() {
    const double even = static_cast<double>(options_.sessions) / options_.servers;
    double most = 0;
    std::printf("sessions per server:");
    for (int server = 1; server <= options_.servers; ++server) {
      const double held = deployment_.Metric(server, "phrenic_sessions");
      most = std::max(most, held);
      std::printf(" %.0f", held);
    }
    std::printf(" (the maximum is %.2f times the mean)\n\n", most / even);
    return most > 0;
  }

  Cpu Spent() const {
    Cpu cpu{.servers = 0, .nginx = deployment_.Cpu("nginx"), .redis = deployment_.Cpu("redis")};
    for (int i = 1; i <= options_.servers; ++i) cpu.servers += deployment_.Cpu(absl::StrCat("server-", i));
    return cpu;
  }

  bool Step() {
    std::vector<std::vector<double>> took(kCallers);
    const absl::Time begin = absl::Now(), end = begin + absl::Seconds(options_.seconds);
    const Cpu before = Spent();
    const auto step = [&](v1::SessionService::Stub& stub, int caller) {
      grpc::Status status;
      for (int i = caller; absl::Now() < end && status.ok();
           i = i + kCallers < options_.sessions ? i + kCallers : caller) {
        v1::StepSessionRequest request;
        request.set_session_id(NameOf(i));
        request.set_ticks(kTicksPerCall);
        v1::StepSessionResponse stepped;
        Call call(NameOf(i));
        const absl::Time asked = absl::Now();
        status = stub.StepSession(&call, request, &stepped);
        took[caller].push_back(absl::ToDoubleMilliseconds(absl::Now() - asked));
      }
      return status;
    };
    const grpc::Status stepped = ForEach(kCallers, step);
    if (!stepped.ok()) return Fail(absl::StrCat("a session could not be stepped: ", stepped.error_message()));
    const double wall = absl::ToDoubleSeconds(absl::Now() - begin);
    const Cpu after = Spent();
    std::vector<double> all;
    for (const auto& each : took) all.insert(all.end(), each.begin(), each.end());
    const auto calls = static_cast<double>(all.size());
    std::printf("stepped by one client, %d concurrent calls through nginx: %.0f calls/s, %.0f steps/s\n", kCallers,
                calls / wall, kTicksPerCall * calls / wall);
    std::printf(
        "  latency %.1f ms (p50), %.1f ms (p99); CPU per call: %.0f us servers, %.0f us nginx, %.0f us Redis\n\n",
        Quantile(all, 0.5), Quantile(all, 0.99), 1e6 * (after.servers - before.servers) / calls,
        1e6 * (after.nginx - before.nginx) / calls, 1e6 * (after.redis - before.redis) / calls);
    return true;
  }

  bool WatchBothWays() {
    std::printf("%-24s %9s %8s %8s %8s %8s %22s %22s\n", "viewers", "sessions", "fps", "p50 ms", "p99 ms", "bytes",
                "us of servers/frame", "us of nginx/frame");
    return Watched("through nginx, TLS", true) && Watched("directly, no TLS", false);
  }

  // Measures viewers through nginx, or directly of sessions that are created on each server.
  bool Watched(const char* label, bool through_nginx) {
    const int sessions = std::max(1, options_.viewers / kViewersPerSession);
    std::vector<std::shared_ptr<grpc::Channel>> channels;
    const auto channel = [&](int session) {
      return through_nginx ? deployment_.NewChannel() : deployment_.NewChannelTo(1 + session % options_.servers);
    };
    const auto name = [&](int session) { return through_nginx ? NameOf(session) : absl::StrCat("direct-", session); };
    for (int i = 0; i < sessions; ++i) {
      const auto stub = v1::SessionService::NewStub(channel(i));
      grpc::Status ready = through_nginx ? grpc::Status::OK : Make(*stub, name(i));
      if (ready.ok()) ready = Play(*stub, name(i));
      if (!ready.ok()) return Fail(absl::StrCat("a session does not play: ", ready.error_message()));
    }
    bench::Seen seen;
    std::vector<std::unique_ptr<Viewer>> viewers;
    viewers.reserve(static_cast<std::size_t>(options_.viewers));
    for (int i = 0; i < options_.viewers; ++i) {
      viewers.push_back(Watch(channel(i % sessions), name(i % sessions), seen));
    }
    absl::SleepFor(absl::Seconds(5));
    seen.Take();
    const Cpu before = Spent();
    absl::SleepFor(absl::Seconds(options_.seconds));
    const bench::Sight sight = seen.Take();
    const Cpu after = Spent();
    const auto frames = static_cast<double>(sight.frames);
    if (frames == 0) return Fail("no frame arrived");
    std::printf("%4d %-19s %9d %8.1f %8.1f %8.1f %8.0f %22.0f %22.0f\n", options_.viewers, label, sessions,
                frames / options_.viewers / options_.seconds, 1e3 * sight.Age(0.5), 1e3 * sight.Age(0.99),
                static_cast<double>(sight.bytes) / frames, 1e6 * (after.servers - before.servers) / frames,
                1e6 * (after.nginx - before.nginx) / frames);
    std::fflush(stdout);
    viewers.clear();
    return Pause(sessions, channel, name);
  }

  template <typename ChannelOf, typename Name>
  bool Pause(int sessions, const ChannelOf& channel, const Name& name) {
    for (int i = 0; i < sessions; ++i) {
      v1::PauseSessionRequest pause;
      pause.set_session_id(name(i));
      v1::PauseSessionResponse paused;
      Call call(name(i));
      const grpc::Status status = v1::SessionService::NewStub(channel(i))->PauseSession(&call, pause, &paused);
      if (!status.ok()) return Fail(absl::StrCat(name(i), ": ", status.error_message()));
    }
    return true;
  }

  const Options options_;
  Deployment deployment_;
};

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("cluster_scale: measures many sessions and viewers on a local cluster.");
  app.add_option("--servers", options.servers, "servers")->check(CLI::Range(1, 16))->capture_default_str();
  app.add_option("--sessions", options.sessions, "small sessions")->check(CLI::Range(80, 1000))->capture_default_str();
  app.add_option("--viewers", options.viewers, "viewers, 25 per session")
      ->check(CLI::Range(1, 2000))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "duration of each measurement [s]")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!HasTools()) return kSkipped;
  return Scale(options).Run() ? 0 : 1;
}

}  // namespace
}  // namespace phrenic::cluster

int main(int argc, char** argv) { return phrenic::cluster::Main(argc, argv); }
