// What a call has returned survives SIGKILL.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "tests/support/server_process.h"

namespace phrenic::service {
namespace {

class KillTest : public testing::Test {
 protected:
  KillTest() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~KillTest() override {
    server_.Kill();
    std::filesystem::remove_all(folder_);
  }
  std::unique_ptr<v1::SessionService::Stub> Sessions() const {
    return v1::SessionService::NewStub(server_.NewChannel());
  }
  void Create(const std::string& id) const {
    v1::CreateSessionRequest request;
    request.set_session_id(id);
    request.mutable_source()->set_name("sheet-2d");
    v1::CreateSessionResponse created;
    grpc::ClientContext context;
    ASSERT_TRUE(Sessions()->CreateSession(&context, request, &created).ok());
  }
  v1::Session Get(const std::string& id) const {
    v1::GetSessionRequest request;
    request.set_session_id(id);
    v1::GetSessionResponse response;
    grpc::ClientContext context;
    const grpc::Status status = Sessions()->GetSession(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.session();
  }
  static bool Step(v1::SessionService::Stub& stub, const std::string& id, v1::Session& session) {
    v1::StepSessionRequest request;
    request.set_session_id(id);
    request.set_ticks(1);
    v1::StepSessionResponse response;
    grpc::ClientContext context;
    if (!stub.StepSession(&context, request, &response).ok()) return false;
    session = response.session();
    return true;
  }
  static bool Set(v1::SessionService::Stub& stub, const std::string& id, double force, v1::Session& session) {
    v1::UpdateParametersRequest request;
    request.set_session_id(id);
    request.mutable_parameters()->set_breath_force(force);
    v1::UpdateParametersResponse response;
    grpc::ClientContext context;
    if (!stub.UpdateParameters(&context, request, &response).ok()) return false;
    session = response.session();
    return true;
  }

  const std::string folder_ = testing::TempDir() + "phrenic_kill_" + std::to_string(getpid());
  ServerProcess server_{folder_ + "/log", {"--store", folder_ + "/store"}};
};

TEST_F(KillTest, EveryAcknowledgedStepAndChangeSurvives) {
  ASSERT_TRUE(server_.Start().ok()) << server_.output();
  for (const char* id : {"a", "b"}) Create(id);
  for (int round = 1; round <= 8; ++round) {
    // Another session's changes make the store sync meanwhile.
    std::atomic<bool> ended = false;
    std::thread other([&] {
      const auto stub = Sessions();
      v1::Session session;
      for (int i = 1; !ended && Set(*stub, "b", 1 + 0.01 * (i % 50), session); ++i) continue;
    });
    const auto stub = Sessions();
    v1::Session acknowledged;
    const absl::Time end = absl::Now() + absl::Milliseconds(200 + 30 * round);
    for (int i = 1; absl::Now() < end; ++i) {
      ASSERT_TRUE(Step(*stub, "a", acknowledged));
      const bool changed = i % 20 != 0 || Set(*stub, "a", 1 + 0.01 * (i % 90), acknowledged);
      ASSERT_TRUE(changed);
    }
    server_.Signal(SIGKILL);
    server_.Await(10);
    ended = true;
    other.join();
    ASSERT_TRUE(server_.Start().ok()) << server_.output();
    const v1::Session restored = Get("a");
    EXPECT_EQ(restored.tick(), acknowledged.tick()) << "round " << round;
    EXPECT_EQ(restored.parameters().breath_force(), acknowledged.parameters().breath_force()) << "round " << round;
    EXPECT_EQ(restored.revision(), acknowledged.revision()) << "round " << round;
  }
}

// Prints the rate, for people.
TEST_F(KillTest, StepsDoNotWaitForTheDiskToTurn) {
  ASSERT_TRUE(server_.Start().ok()) << server_.output();
  Create("a");
  const auto stub = Sessions();
  v1::Session session;
  const absl::Time start = absl::Now();
  int steps = 0;
  while (absl::Now() < start + absl::Seconds(2)) steps += Step(*stub, "a", session) ? 1 : 0;
  std::printf("%.0f steps/s, one a call, saved\n", steps / absl::ToDoubleSeconds(absl::Now() - start));
  EXPECT_GT(steps, 100);
}

}  // namespace
}  // namespace phrenic::service
