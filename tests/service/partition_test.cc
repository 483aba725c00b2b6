// A server that is cut off from Redis acknowledges no change that its successor lacks.
#include <gmock/gmock.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "phrenic/v1/access.grpc.pb.h"
#include "phrenic/v1/control.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"
#include "tests/cluster/cut_proxy.h"
#include "tests/cluster/redis_server.h"
#include "tests/service/call.h"
#include "tests/support/free_ports.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using Sessions = v1::SessionService::Stub;

// Returns true once the condition is true; false after a minute.
template <class Wanted>
bool Eventually(const Wanted& wanted) {
  for (const absl::Time end = absl::Now() + absl::Minutes(1); absl::Now() < end;
       absl::SleepFor(absl::Milliseconds(20))) {
    if (wanted()) return true;
  }
  return false;
}

// One server of the cluster.
class Member {
 public:
  Member(const std::string& folder, int redis_port) {
    ServerOptions options;
    // The other servers call it at the port that they know it by.
    options.listen = absl::StrCat("127.0.0.1:", FreePorts());
    options.store_dir = folder;
    options.cluster = {.redis = absl::StrCat("redis://127.0.0.1:", redis_port), .advertise = options.listen};
    auto server = Server::Start(options);
    EXPECT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    const auto channel = grpc::CreateChannel(options.listen, grpc::InsecureChannelCredentials());
    sessions_ = v1::SessionService::NewStub(channel);
    control_ = v1::ControlService::NewStub(channel);
  }

  grpc::Status Create(const std::string& id) {
    v1::CreateSessionResponse response;
    return Call(*sessions_, &Sessions::CreateSession,
                absl::StrCat("session_id: '", id, "' source { name: 'cube-springs' }"), &response);
  }
  grpc::Status Step(const std::string& more, v1::StepSessionResponse* response) {
    return Call(*sessions_, &Sessions::StepSession, absl::StrCat("session_id: 's' ticks: 1 ", more), response);
  }
  grpc::Status Delete() {
    v1::DeleteSessionResponse response;
    return Call(*sessions_, &Sessions::DeleteSession, "session_id: 's'", &response);
  }
  // Returns the session as this server, or the one that it asks, sees it; nothing if it cannot be read.
  std::optional<v1::Session> Get() {
    v1::GetSessionResponse response;
    if (!Call(*sessions_, &Sessions::GetSession, "session_id: 's'", &response).ok()) return std::nullopt;
    return response.session();
  }
  // Calls every method that changes a session. Returns the status of each.
  std::vector<std::pair<std::string, grpc::Status>> ChangeInEveryWay() {
    std::vector<std::pair<std::string, grpc::Status>> statuses;
    const auto note = [&](const char* method, const grpc::Status& status) { statuses.emplace_back(method, status); };
    v1::StepSessionResponse stepped;
    note("StepSession", Step("", &stepped));
    v1::PlaySessionResponse played;
    note("PlaySession", Call(*sessions_, &Sessions::PlaySession, "session_id: 's'", &played));
    v1::PauseSessionResponse paused;
    note("PauseSession", Call(*sessions_, &Sessions::PauseSession, "session_id: 's'", &paused));
    v1::ResetSessionResponse reset;
    note("ResetSession", Call(*sessions_, &Sessions::ResetSession, "session_id: 's'", &reset));
    v1::UpdateParametersResponse updated;
    note("UpdateParameters",
         Call(*sessions_, &Sessions::UpdateParameters, "session_id: 's' parameters { elasticity: 1.5 }", &updated));
    v1::PullSessionResponse pulled;
    note("PullSession", Call(*sessions_, &Sessions::PullSession, "session_id: 's' release_others: true", &pulled));
    v1::ForkSessionResponse forked;
    note("ForkSession", Call(*sessions_, &Sessions::ForkSession, "session_id: 's' fork_id: 'f'", &forked));
    note("CreateSession", Create("new"));
    v1::EnterSessionResponse entered;
    note("EnterSession",
         Call(*control_, &v1::ControlService::Stub::EnterSession, "session_id: 's' name: 'Anna'", &entered));
    note("DeleteSession", Delete());
    return statuses;
  }

 private:
  std::unique_ptr<Server> server_;
  std::unique_ptr<Sessions> sessions_;
  std::unique_ptr<v1::ControlService::Stub> control_;
};

// Steps session "s" at one server, one tick a call, and counts.
class Stepper {
 public:
  explicit Stepper(Member& server) : thread_([this, &server] { Work(server); }) {}
  ~Stepper() { Stop(); }
  void Stop() {
    stopped_ = true;
    if (thread_.joinable()) thread_.join();
  }
  // The last tick that was acknowledged at epoch 1.
  std::int64_t acknowledged() const { return acknowledged_; }
  int refused() const { return refused_; }

 private:
  void Work(Member& server) {
    while (!stopped_) {
      v1::StepSessionResponse response;
      const grpc::Status status = server.Step("", &response);
      if (status.ok() && response.session().epoch() == 1) acknowledged_ = response.session().tick();
      if (status.error_code() == grpc::StatusCode::UNAVAILABLE) ++refused_;
      absl::SleepFor(absl::Milliseconds(status.ok() ? 5 : 50));
    }
  }

  std::atomic<bool> stopped_ = false;
  std::atomic<std::int64_t> acknowledged_ = 0;
  std::atomic<int> refused_ = 0;
  std::thread thread_;
};

// Two servers; the network between `a` and Redis can be cut.
class PartitionTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!cluster::RedisServer::Installed()) GTEST_SKIP() << "there is no redis-server here (deploy/packages.txt)";
    std::signal(SIGPIPE, SIG_IGN);
    std::filesystem::remove_all(folder_);
    redis_ = std::make_unique<cluster::RedisServer>();
    network_ = std::make_unique<cluster::CutProxy>(redis_->port());
    a_ = std::make_unique<Member>(folder_ + "/a", network_->port());
    b_ = std::make_unique<Member>(folder_ + "/b", redis_->port());
    const grpc::Status created = a_->Create("s");
    ASSERT_TRUE(created.ok()) << created.error_message();
    // Each server takes nothing over in the first 3 s.
    absl::SleepFor(absl::Seconds(3.5));
  }
  ~PartitionTest() override {
    if (redis_ != nullptr) redis_->Signal(SIGCONT);
    if (network_ != nullptr) network_->Cut(false);
    a_.reset();
    b_.reset();
    std::filesystem::remove_all(folder_);
  }
  // Returns the session once `server` has it at a later epoch than the first.
  static std::optional<v1::Session> TakenOver(Member& server) {
    std::optional<v1::Session> session;
    Eventually([&] {
      session = server.Get();
      return session.has_value() && session->epoch() > 1;
    });
    return session;
  }

  const std::string folder_ = testing::TempDir() + "phrenic_partition_" + std::to_string(getpid());
  std::unique_ptr<cluster::RedisServer> redis_;
  std::unique_ptr<cluster::CutProxy> network_;
  std::unique_ptr<Member> a_, b_;
};

TEST_F(PartitionTest, NoAcknowledgedChangeIsLostToTheSuccessor) {
  Stepper stepper(*a_);
  ASSERT_TRUE(Eventually([&] { return stepper.acknowledged() > 50; }));
  network_->Cut(true);
  const auto successor = TakenOver(*b_);
  ASSERT_TRUE(successor.has_value());
  const int refused = stepper.refused();
  ASSERT_TRUE(Eventually([&] { return stepper.refused() > refused + 5; }));
  stepper.Stop();
  EXPECT_GE(successor->tick(), stepper.acknowledged()) << "acknowledged steps are lost";
  EXPECT_LE(successor->tick(), stepper.acknowledged() + 1) << "one call was on its way";
  network_->Cut(false);
  const auto seen = TakenOver(*a_);
  ASSERT_TRUE(seen.has_value()) << "the first server passes calls on to the second";
  EXPECT_EQ(seen->epoch(), successor->epoch());
}

TEST_F(PartitionTest, EveryChangeIsRefusedAfterTheLeaseAndReadingGoesOn) {
  network_->Cut(true);
  ASSERT_TRUE(Eventually([&] {
    const auto session = a_->Get();
    return session.has_value() && !session->not_saved().empty();
  }));
  EXPECT_THAT(a_->Get()->not_saved(), HasSubstr("lease on it has ended"));
  const v1::Session before = *a_->Get();
  for (const auto& [method, status] : a_->ChangeInEveryWay()) {
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAVAILABLE) << method << ": " << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr("Redis")) << method;
  }
  EXPECT_EQ(a_->Get()->tick(), before.tick());
  EXPECT_EQ(a_->Get()->revision(), before.revision());
  const auto successor = TakenOver(*b_);
  ASSERT_TRUE(successor.has_value()) << "it was not deleted";
  EXPECT_EQ(successor->revision(), before.revision());
}

TEST_F(PartitionTest, ChangesWaitOutAShortCutAndNoneIsLostOrMadeTwice) {
  std::int64_t tick = a_->Get()->tick();
  network_->Cut(true);
  std::thread heal([this] {
    absl::SleepFor(absl::Seconds(1));
    network_->Cut(false);
  });
  v1::StepSessionResponse response;
  const std::string once = "request_id: 'once'";
  grpc::Status status = a_->Step(once, &response);
  for (int tries = 0; tries < 40 && status.error_code() == grpc::StatusCode::UNAVAILABLE; ++tries) {
    absl::SleepFor(absl::Milliseconds(200));
    status = a_->Step(once, &response);
  }
  heal.join();
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.session().tick(), tick + 1);
  EXPECT_EQ(a_->Get()->tick(), tick + 1) << "a repeat stepped again";
}

// SIGSTOP: connections stay, nothing answers, and all leases have ended when it continues.
TEST_F(PartitionTest, AFrozenRedisLosesNothingAndTheServerRegainsItsSession) {
  Stepper stepper(*a_);
  ASSERT_TRUE(Eventually([&] { return stepper.acknowledged() > 50; }));
  redis_->Signal(SIGSTOP);
  ASSERT_TRUE(Eventually([&] { return stepper.refused() > 10; }));
  const auto frozen = a_->Get();
  ASSERT_TRUE(frozen.has_value()) << "it can be read";
  EXPECT_THAT(frozen->not_saved(), testing::Not(testing::IsEmpty()));
  redis_->Signal(SIGCONT);
  const std::int64_t before = stepper.acknowledged();
  ASSERT_TRUE(Eventually([&] {
    const auto session = a_->Get();
    return session.has_value() && (session->epoch() > 1 || stepper.acknowledged() > before + 20);
  }));
  stepper.Stop();
  EXPECT_GE(a_->Get()->tick(), stepper.acknowledged());
  ASSERT_TRUE(Eventually([&] {
    const auto session = a_->Get();
    return session.has_value() && session->not_saved().empty();
  }));
}

}  // namespace
}  // namespace phrenic::service
