// phrenicd killed at random moments, by SIGKILL: its sessions are there again, bit for bit.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::service {
namespace {

constexpr int kKills = 100;
constexpr std::int64_t kTicksAStep = 7;

// A phrenicd of its own on a store that outlives it.
class Daemon {
 public:
  explicit Daemon(std::string folder) : folder_(std::move(folder)) { Start(); }
  ~Daemon() { Kill(); }
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  void Start() {
    const std::string out = folder_ + "/said";
    std::filesystem::remove(out);
    pid_ = fork();
    if (pid_ == 0) {
      const int file = open(out.c_str(), O_CREAT | O_WRONLY, 0600);
      dup2(file, 1);
      dup2(file, 2);
      execl(PHRENIC_BINARY_DIR "/phrenicd", "phrenicd", "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--start",
            "none", "--store", (folder_ + "/store").c_str(), nullptr);
      _exit(127);
    }
    std::string said;
    for (int tries = 0; tries < 1000 && said.find("Viewer:") == std::string::npos; ++tries) {
      absl::SleepFor(absl::Milliseconds(10));
      std::ifstream in(out);
      said.assign(std::istreambuf_iterator<char>(in), {});
    }
    const std::size_t at = said.find("gRPC:   ");
    ASSERT_NE(at, std::string::npos) << said;
    const std::string address = said.substr(at + 8, said.find('\n', at) - at - 8);
    sessions_ = v1::SessionService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  }
  void Kill() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  v1::SessionService::Stub& sessions() { return *sessions_; }

 private:
  const std::string folder_;
  pid_t pid_ = -1;
  std::unique_ptr<v1::SessionService::Stub> sessions_;
};

class KillTest : public testing::Test {
 protected:
  KillTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~KillTest() override { std::filesystem::remove_all(folder_); }

  static void Create(v1::SessionService::Stub& sessions, const std::string& id) {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    request.mutable_source()->set_name("sheet-2d");
    v1::CreateSessionResponse created;
    grpc::ClientContext context;
    const grpc::Status status = sessions.CreateSession(&context, request, &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  static std::optional<v1::Session> Get(v1::SessionService::Stub& sessions, const std::string& id) {
    v1::GetSessionRequest request;
    request.set_session_id(id);
    v1::GetSessionResponse got;
    grpc::ClientContext context;
    if (!sessions.GetSession(&context, request, &got).ok()) return std::nullopt;
    return got.session();
  }
  // The force is a function of the tick, so that whoever repeats a change makes the same one.
  static bool Advance(v1::SessionService::Stub& sessions, const std::string& id, std::int64_t tick,
                      v1::StepSessionResponse& stepped) {
    if (tick % (5 * kTicksAStep) == 0) {
      v1::UpdateParametersRequest update;
      update.set_session_id(id);
      update.mutable_parameters()->set_breath_force(0.5 + 0.001 * static_cast<double>(tick % 997));
      v1::UpdateParametersResponse updated;
      grpc::ClientContext context;
      if (!sessions.UpdateParameters(&context, update, &updated).ok()) return false;
    }
    v1::StepSessionRequest step;
    step.set_session_id(id);
    step.set_ticks(kTicksAStep);
    step.set_expected_tick(tick);
    grpc::ClientContext context;
    return sessions.StepSession(&context, step, &stepped).ok();
  }

  const std::string folder_ = testing::TempDir() + "phrenic_kill_" + std::to_string(getpid());
};

TEST_F(KillTest, AHundredKillsLoseNoSessionAndNoBit) {
  Daemon daemon(folder_);
  Create(daemon.sessions(), "stepped");
  Create(daemon.sessions(), "whole");
  Create(daemon.sessions(), "played");
  v1::PlaySessionRequest play;
  play.set_session_id("played");
  v1::PlaySessionResponse played;
  grpc::ClientContext playing;
  ASSERT_TRUE(daemon.sessions().PlaySession(&playing, play, &played).ok());
  std::mt19937 random(3);
  v1::StepSessionResponse stepped;
  std::int64_t tick = 0, lost = 0;
  for (int kills = 1; kills <= kKills; ++kills) {
    std::thread killer([&daemon, wait = 1 + random() % 60] {
      absl::SleepFor(absl::Milliseconds(wait));
      daemon.Kill();
    });
    while (Advance(daemon.sessions(), "stepped", tick, stepped)) tick = stepped.session().tick();
    killer.join();
    daemon.Start();
    const auto session = Get(daemon.sessions(), "stepped"), other = Get(daemon.sessions(), "played");
    ASSERT_TRUE(session.has_value() && other.has_value()) << "after kill " << kills;
    lost = std::max(lost, tick - session->tick());
    EXPECT_EQ(other->state(), v1::SESSION_STATE_PLAYING);
    tick = session->tick() / kTicksAStep * kTicksAStep == session->tick() ? session->tick() : -1;
    if (tick >= 0) continue;
    // It stands within a call's steps: those are finished first.
    v1::StepSessionRequest rest;
    rest.set_session_id("stepped");
    rest.set_ticks(kTicksAStep - session->tick() % kTicksAStep);
    grpc::ClientContext context;
    ASSERT_TRUE(daemon.sessions().StepSession(&context, rest, &stepped).ok());
    tick = stepped.session().tick();
  }
  ASSERT_TRUE(Advance(daemon.sessions(), "stepped", tick, stepped));
  std::printf("kills: %d, in %lld ticks; answered steps done again: %lld ticks at most\n", kKills,
              static_cast<long long>(tick), static_cast<long long>(lost));
  v1::StepSessionResponse whole;
  for (std::int64_t at = 0; at <= tick; at = whole.session().tick()) {
    ASSERT_TRUE(Advance(daemon.sessions(), "whole", at, whole));
  }
  EXPECT_EQ(stepped.session().tick(), whole.session().tick());
  EXPECT_EQ(stepped.state_hash(), whole.state_hash());
}

}  // namespace
}  // namespace phrenic::service
