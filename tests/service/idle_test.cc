// A server at rest leaves the machine alone.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "tests/support/server_process.h"

namespace phrenic::service {
namespace {

constexpr double kMost = 0.01;  // of a core

// Watches a session until it is destroyed.
class Viewer {
 public:
  Viewer(const std::shared_ptr<grpc::Channel>& channel, const std::string& session)
      : stub_(v1::FrameService::NewStub(channel)), thread_([this, session] { Read(session); }) {}
  ~Viewer() {
    context_.TryCancel();
    thread_.join();
  }

 private:
  void Read(const std::string& session) {
    v1::WatchFramesRequest request;
    request.set_session_id(session);
    const auto stream = stub_->WatchFrames(&context_, request);
    v1::WatchFramesResponse event;
    while (stream->Read(&event)) continue;
    stream->Finish();
  }

  std::unique_ptr<v1::FrameService::Stub> stub_;
  grpc::ClientContext context_;
  std::thread thread_;
};

class IdleTest : public testing::Test {
 protected:
  IdleTest() { std::filesystem::remove_all(folder_); }
  ~IdleTest() override {
    server_.Kill();
    std::filesystem::remove_all(folder_);
  }
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    const absl::Status started = server_.Start();
    ASSERT_TRUE(started.ok()) << started;
  }
  // Creates a session, changes it and steps it.
  void Create(const std::string& id, const std::string& scene) const {
    const auto stub = v1::SessionService::NewStub(server_.NewChannel());
    v1::CreateSessionRequest create;
    create.set_session_id(id);
    create.mutable_source()->set_name(scene);
    v1::CreateSessionResponse created;
    grpc::ClientContext creating, stepping;
    ASSERT_TRUE(stub->CreateSession(&creating, create, &created).ok());
    v1::StepSessionRequest step;
    step.set_session_id(id);
    step.set_ticks(5);
    v1::StepSessionResponse stepped;
    ASSERT_TRUE(stub->StepSession(&stepping, step, &stepped).ok());
  }
  // Returns the smallest share of a core over some seconds, as the machine may disturb one of them.
  double Share() const {
    constexpr int kTries = 5;
    const absl::Duration time = absl::Seconds(2);
    double least = 1;
    absl::SleepFor(time);  // what was started has ended
    for (int i = 0; i < kTries && least >= kMost; ++i) {
      const double before = server_.Cpu();
      absl::SleepFor(time);
      least = std::min(least, (server_.Cpu() - before) / absl::ToDoubleSeconds(time));
    }
    return least;
  }

  const std::string folder_ = testing::TempDir() + "phrenic_idle_" + std::to_string(getpid());
  ServerProcess server_{folder_ + ".log", {"--store", folder_ + "/store"}};
};

TEST_F(IdleTest, PausedSessionsWithIdleViewersUseNoProcessor) {
  EXPECT_LT(Share(), kMost) << "no session";
  for (int i = 0; i < 12; ++i) Create(absl::StrCat("s", i), i % 2 == 0 ? "sheet-2d" : "mixed-methods");
  EXPECT_LT(Share(), kMost) << "paused sessions";
  std::vector<std::unique_ptr<Viewer>> viewers;
  viewers.reserve(8);
  for (int i = 0; i < 8; ++i) {
    viewers.push_back(std::make_unique<Viewer>(server_.NewChannel(), absl::StrCat("s", i)));
  }
  EXPECT_LT(Share(), kMost) << "idle viewers";
}

}  // namespace
}  // namespace phrenic::service
