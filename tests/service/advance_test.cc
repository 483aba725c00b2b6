// SessionService.Advance: the bits of StepSession, in order, at the speed of the client that reads.
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "absl/time/clock.h"
#include "tests/cluster/redis_server.h"
#include "tests/service/server_fixture.h"
#include "tests/support/free_ports.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using Sessions = v1::SessionService::Stub;

// A stream of steps.
class Advance {
 public:
  explicit Advance(Sessions& sessions) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    stream_ = sessions.Advance(&context_);
  }
  ~Advance() {
    context_.TryCancel();
    if (!finished_) Finish();
  }
  bool Send(const std::string& text) { return stream_->Write(RequestOf<v1::AdvanceRequest>(text)); }
  bool Read(v1::AdvanceResponse* response) { return stream_->Read(response); }
  // Ends the requests, reads the answers that are left, and returns how the stream ended.
  grpc::Status Finish() {
    finished_ = true;
    stream_->WritesDone();
    v1::AdvanceResponse response;
    while (stream_->Read(&response)) ++unread_;
    return stream_->Finish();
  }
  int unread() const { return unread_; }

 private:
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::AdvanceRequest, v1::AdvanceResponse>> stream_;
  bool finished_ = false;
  int unread_ = 0;
};

class AdvanceTest : public ServerFixture {
 protected:
  std::int64_t Tick(const std::string& id) {
    v1::GetSessionResponse got;
    EXPECT_TRUE(Call(*sessions_, &Sessions::GetSession, "session_id: '" + id + "'", &got).ok());
    return got.session().tick();
  }
  // Waits until the session takes no more steps. Returns its tick.
  std::int64_t AwaitStandstill(const std::string& id) {
    std::int64_t before = -1, now = 0;
    for (; now > before; now = Tick(id)) {
      before = now;
      absl::SleepFor(absl::Seconds(1));
    }
    return now;
  }
  static void ExpectError(const grpc::Status& status, grpc::StatusCode code, const std::string& part) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(part));
  }
};

TEST_F(AdvanceTest, GivesTheStatesOfStepSessionAlsoWhenRequestsAreSentAhead) {
  CreateCube("stream");
  CreateCube("calls");
  Advance stream(*sessions_);
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(stream.Send(absl::StrCat("session_id: 'stream' ticks: 7 expected_tick: ", 7 * i,
                                         " read: [STATE_PART_POSITIONS, STATE_PART_VELOCITIES]")));
  }
  for (int i = 1; i <= 20; ++i) {
    v1::AdvanceResponse answer;
    ASSERT_TRUE(stream.Read(&answer));
    v1::StepSessionResponse stepped;
    ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession,
                     "session_id: 'calls' ticks: 7 read: [STATE_PART_POSITIONS, STATE_PART_VELOCITIES]", &stepped)
                    .ok());
    EXPECT_EQ(answer.state().tick(), 7 * i);
    EXPECT_EQ(answer.state_hash(), stepped.state_hash());
    EXPECT_EQ(answer.state().SerializeAsString(), stepped.state().SerializeAsString());
    EXPECT_FALSE(answer.has_session());
  }
  EXPECT_TRUE(stream.Finish().ok());
}

TEST_F(AdvanceTest, ChangesParametersBeforeItsSteps) {
  CreateCube("stream");
  CreateCube("calls");
  Advance stream(*sessions_);
  v1::AdvanceResponse answer;
  v1::StepSessionResponse stepped;
  for (const char* force : {"0.5", "2"}) {
    const std::string change = absl::StrCat(" parameters { breath_force: ", force, " }");
    ASSERT_TRUE(stream.Send("session_id: 'stream' ticks: 10" + change));
    ASSERT_TRUE(stream.Read(&answer));
    ASSERT_TRUE(Session(&Sessions::UpdateParameters, "session_id: 'calls'" + change).ok());
    ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'calls' ticks: 10", &stepped).ok());
    EXPECT_EQ(answer.state_hash(), stepped.state_hash());
    EXPECT_EQ(answer.session().parameters().breath_force(), stepped.session().parameters().breath_force());
  }
  EXPECT_TRUE(stream.Finish().ok());
}

TEST_F(AdvanceTest, AClientThatDoesNotReadStopsTheSessionAndLosesNothing) {
  v1::CreateSessionResponse created;
  ASSERT_TRUE(
      Call(*sessions_, &Sessions::CreateSession, "session_id: 's' source { name: 'hanging-sheet' }", &created).ok());
  constexpr int kRequests = 3000;
  Advance stream(*sessions_);
  std::thread sender([&] {
    for (int i = 0; i < kRequests; ++i) {
      stream.Send("session_id: 's' ticks: 1 read: [STATE_PART_POSITIONS, STATE_PART_VELOCITIES, STATE_PART_BODIES]");
    }
  });
  EXPECT_LT(AwaitStandstill("s"), kRequests / 2) << "the server went on while nothing was read";
  for (int i = 1; i <= kRequests; ++i) {
    v1::AdvanceResponse answer;
    ASSERT_TRUE(stream.Read(&answer)) << i;
    ASSERT_EQ(answer.state().tick(), i);
  }
  sender.join();
  EXPECT_TRUE(stream.Finish().ok());
}

TEST_F(AdvanceTest, TheFirstErrorEndsItAfterTheAnswersBefore) {
  CreateCube("s");
  Advance stream(*sessions_);
  stream.Send("session_id: 's' ticks: 1 expected_tick: 0");
  stream.Send("session_id: 's' ticks: 1 expected_tick: 5");
  stream.Send("session_id: 's' ticks: 1");
  ExpectError(stream.Finish(), grpc::ABORTED, "tick");
  EXPECT_EQ(stream.unread(), 1);
  EXPECT_EQ(Tick("s"), 1);
}

TEST_F(AdvanceTest, ErrorsNameTheField) {
  CreateCube("s");
  const struct {
    const char* request;
    grpc::StatusCode code;
    const char* words;
  } cases[] = {{"session_id: 'x' ticks: 1", grpc::NOT_FOUND, "there is no session \"x\""},
               {"session_id: 's'", grpc::INVALID_ARGUMENT, "ticks"},
               {"session_id: 's' ticks: 1 parameters { breath_force: 99 }", grpc::INVALID_ARGUMENT, "breath_force"},
               {"session_id: 's' ticks: 1 read: 77", grpc::INVALID_ARGUMENT, "read"}};
  for (const auto& one : cases) {
    Advance stream(*sessions_);
    stream.Send(one.request);
    ExpectError(stream.Finish(), one.code, one.words);
  }
  ExpectError(Advance(*sessions_).Finish(), grpc::INVALID_ARGUMENT, "no request");
}

TEST_F(AdvanceTest, StreamsThatWaitForRequestsAreLimitedAndBlockNoOther) {
  CreateCube("s");
  std::vector<std::unique_ptr<Advance>> streams;
  for (int i = 0; i < 16; ++i) {
    streams.push_back(std::make_unique<Advance>(*sessions_));
    v1::AdvanceResponse answer;
    ASSERT_TRUE(streams.back()->Send("session_id: 's' ticks: 1"));
    ASSERT_TRUE(streams.back()->Read(&answer));
  }
  Advance further(*sessions_);
  v1::AdvanceResponse answer;
  ASSERT_TRUE(further.Send("session_id: 's' ticks: 1"));
  EXPECT_TRUE(further.Read(&answer)) << "a request that is there is answered";
  ExpectError(further.Finish(), grpc::RESOURCE_EXHAUSTED, "--max-calls");
  v1::StepSessionResponse stepped;
  EXPECT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 's' ticks: 1", &stepped).ok());
}

// A server of a cluster passes each request on.
class AdvanceInACluster : public AdvanceTest {
 protected:
  AdvanceInACluster() {
    if (!cluster::RedisServer::Installed()) return;
    redis_ = std::make_unique<cluster::RedisServer>();
    folder_ = absl::StrCat(testing::TempDir(), "/phrenic-advance-store-", getpid());
    std::filesystem::create_directories(folder_);
    options_.store_dir = folder_;
    options_.listen = absl::StrCat("127.0.0.1:", FreePorts());
    options_.cluster = {.redis = redis_->url(), .advertise = options_.listen};
  }
  ~AdvanceInACluster() override {
    server_.reset();
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  void SetUp() override {
    if (redis_ == nullptr) GTEST_SKIP() << "there is no redis-server here (deploy/packages.txt)";
    AdvanceTest::SetUp();
  }

  std::unique_ptr<cluster::RedisServer> redis_;
  std::string folder_;
};

TEST_F(AdvanceInACluster, EachRequestIsPassedOn) {
  CreateCube("s");
  Advance stream(*sessions_);
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(stream.Send(absl::StrCat("session_id: 's' ticks: 2 expected_tick: ", 2 * i)));
  for (int i = 1; i <= 10; ++i) {
    v1::AdvanceResponse answer;
    ASSERT_TRUE(stream.Read(&answer));
    EXPECT_EQ(answer.state().tick(), 2 * i);
  }
  stream.Send("session_id: 'x' ticks: 1");
  ExpectError(stream.Finish(), grpc::NOT_FOUND, "there is no session \"x\"");
  ExpectError(Advance(*sessions_).Finish(), grpc::INVALID_ARGUMENT, "no request");
}

}  // namespace
}  // namespace phrenic::service
