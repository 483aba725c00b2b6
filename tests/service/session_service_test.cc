#include <cstring>
#include <thread>
#include <vector>

#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using Sessions = v1::SessionService::Stub;

class SessionServiceTest : public ServerFixture {
 protected:
  void ExpectError(const grpc::Status& status, grpc::StatusCode code, const std::string& part) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(part));
  }
};

TEST_F(SessionServiceTest, ASessionLivesFromCreateToDelete) {
  CreateCube("cube");
  v1::StepSessionResponse stepped;
  ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'cube' ticks: 10 expected_tick: 0", &stepped).ok());
  EXPECT_EQ(stepped.session().tick(), 10);
  EXPECT_EQ(stepped.state_hash().size(), 16u);
  v1::GetSessionResponse got;
  ASSERT_TRUE(Call(*sessions_, &Sessions::GetSession, "session_id: 'cube'", &got).ok());
  EXPECT_EQ(got.session().time(), stepped.session().time());
  EXPECT_EQ(got.report().scene(), "cube-springs");
  v1::ForkSessionResponse fork;
  ASSERT_TRUE(Call(*sessions_, &Sessions::ForkSession, "session_id: 'cube' fork_id: 'other'", &fork).ok());
  EXPECT_EQ(fork.session().id(), "other");
  EXPECT_EQ(fork.session().tick(), 10);
  EXPECT_TRUE(Session(&Sessions::PlaySession, "session_id: 'cube' speed: 2").ok());
  EXPECT_TRUE(Session(&Sessions::PauseSession, "session_id: 'cube'").ok());
  v1::ResetSessionResponse reset;
  ASSERT_TRUE(Call(*sessions_, &Sessions::ResetSession, "session_id: 'cube'", &reset).ok());
  EXPECT_EQ(reset.session().tick(), 0);
  EXPECT_TRUE(Session(&Sessions::DeleteSession, "session_id: 'cube'").ok());
  ExpectError(Session(&Sessions::GetSession, "session_id: 'cube'"), grpc::NOT_FOUND, "there is no session \"cube\"");
}

TEST_F(SessionServiceTest, EveryCallForASessionThatDoesNotExistIsNotFound) {
  CreateCube("cube");
  const std::string hint = "session_id: there is no session \"x\"; there are cube";
  ExpectError(Session(&Sessions::GetSession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::PlaySession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::ForkSession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::PauseSession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::StepSession, "session_id: 'x' ticks: 1"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::ResetSession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::DeleteSession, "session_id: 'x'"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::UpdateParameters, "session_id: 'x' parameters { }"), grpc::NOT_FOUND, hint);
  ExpectError(Session(&Sessions::GetSession, ""), grpc::INVALID_ARGUMENT, "session_id");
  Watch watch(channel_, "x");
  v1::WatchFramesResponse response;
  EXPECT_FALSE(watch.Read(&response));
  ExpectError(watch.Finish(), grpc::NOT_FOUND, hint);
}

// Returns the numbers of a `bytes` field.
std::vector<double> DoublesOf(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

TEST_F(SessionServiceTest, AStepReturnsThePartsOfTheStateThatAreAskedFor) {
  CreateCube("cube");
  v1::StepSessionResponse stepped;
  ASSERT_TRUE(
      Call(*sessions_, &Sessions::StepSession,
           "session_id: 'cube' ticks: 10 read: [STATE_PART_POSITIONS, STATE_PART_VELOCITIES, STATE_PART_LAYOUT]",
           &stepped)
          .ok());
  EXPECT_EQ(stepped.state().tick(), 10);
  EXPECT_EQ(stepped.state().time(), stepped.session().time());
  ASSERT_EQ(stepped.state().layout().bodies_size(), 1);
  EXPECT_EQ(stepped.state().layout().bodies(0).vertices(), 8);
  const std::vector<double> x = DoublesOf(stepped.state().positions()), v = DoublesOf(stepped.state().velocities());
  ASSERT_EQ(x.size(), 24u);
  ASSERT_EQ(v.size(), 24u);
  EXPECT_LT(v[6 * 3 + 2], 0) << "a free corner has not begun to fall";
  EXPECT_TRUE(stepped.state().body_positions().empty());
  v1::GetStateResponse state;
  ASSERT_TRUE(Call(*sessions_, &Sessions::GetState, "session_id: 'cube' read: STATE_PART_POSITIONS", &state).ok());
  EXPECT_EQ(state.state_hash(), stepped.state_hash());
  EXPECT_EQ(state.state().positions(), stepped.state().positions());
  ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'cube' ticks: 1", &stepped).ok());
  EXPECT_FALSE(stepped.has_state()) << "`read` was empty";
}

TEST_F(SessionServiceTest, AnUnknownPartIsRefusedAndSoIsOneThatAnIdWouldKeep) {
  CreateCube("cube");
  ExpectError(Session(&Sessions::StepSession, "session_id: 'cube' ticks: 1 read: STATE_PART_UNSPECIFIED"),
              grpc::INVALID_ARGUMENT, "read: STATE_PART_UNSPECIFIED is not a part of a state");
  ExpectError(Session(&Sessions::StepSession, "session_id: 'cube' ticks: 1 request_id: 'a' read: STATE_PART_BODIES"),
              grpc::INVALID_ARGUMENT, "read: not with request_id");
  ExpectError(Session(&Sessions::GetState, "session_id: 'x'"), grpc::NOT_FOUND, "there is no session \"x\"");
  v1::GetSessionResponse got;
  ASSERT_TRUE(Call(*sessions_, &Sessions::GetSession, "session_id: 'cube'", &got).ok());
  EXPECT_EQ(got.session().tick(), 0) << "a refused step was taken";
}

TEST_F(SessionServiceTest, FollowingItselfOrAnUnknownSessionIsRefused) {
  CreateCube("cube");
  CreateCube("other");
  EXPECT_TRUE(Session(&Sessions::PlaySession, "session_id: 'cube' in_step_with: 'other'").ok());
  ExpectError(Session(&Sessions::PlaySession, "session_id: 'cube' in_step_with: 'x'"), grpc::NOT_FOUND,
              "in_step_with: there is no session \"x\"");
  ExpectError(Session(&Sessions::PlaySession, "session_id: 'cube' in_step_with: 'cube'"), grpc::INVALID_ARGUMENT,
              "in_step_with: names the session itself");
}

TEST_F(SessionServiceTest, AParameterOutOfRangeIsRefusedWithItsFieldAndRange) {
  CreateCube("cube");
  ExpectError(Session(&Sessions::UpdateParameters, "session_id: 'cube' parameters { breath_force: 21 }"),
              grpc::INVALID_ARGUMENT, "parameters.breath_force: 21 is outside 0 to 20");
  ExpectError(Session(&Sessions::UpdateParameters, "session_id: 'cube' parameters { time_step: nan }"),
              grpc::INVALID_ARGUMENT, "parameters.time_step");
  ExpectError(Session(&Sessions::StepSession, "session_id: 'cube' ticks: 0"), grpc::INVALID_ARGUMENT, "ticks: 0");
  ExpectError(Session(&Sessions::PlaySession, "session_id: 'cube' speed: 1000"), grpc::INVALID_ARGUMENT, "speed");
  ExpectError(Session(&Sessions::ListSessions, "page_size: -1"), grpc::INVALID_ARGUMENT, "page_size");
  ExpectError(Session(&Sessions::CreateSession, "source { name: 'cube-springs' } parameters { breath_length: 0 }"),
              grpc::INVALID_ARGUMENT, "parameters.breath_length");
}

TEST_F(SessionServiceTest, PullsAreSetReplacedAndReleased) {
  CreateCube("cube");
  v1::PullSessionResponse pulled;
  ASSERT_TRUE(Call(*sessions_, &Sessions::PullSession,
                   "session_id: 'cube' pulls { body: 'cube' vertex: 6 force { x: 2 } }", &pulled)
                  .ok());
  EXPECT_EQ(pulled.session().pulls_size(), 1);
  ASSERT_TRUE(Call(*sessions_, &Sessions::PullSession, "session_id: 'cube' release_others: true", &pulled).ok());
  EXPECT_EQ(pulled.session().pulls_size(), 0);
  v1::CreateSessionResponse created;
  ASSERT_TRUE(Call(*sessions_, &Sessions::CreateSession,
                   "source { name: 'cube-springs' } pulls { body: 'cube' vertex: 6 force { x: 2 } }", &created)
                  .ok());
  EXPECT_EQ(created.session().pulls(0).force().x(), 2);
}

TEST_F(SessionServiceTest, AnInvalidPullIsRefused) {
  CreateCube("cube");
  ExpectError(Session(&Sessions::PullSession, "session_id: 'x' release_others: true"), grpc::NOT_FOUND, "no session");
  ExpectError(Session(&Sessions::PullSession, "session_id: 'cube'"), grpc::INVALID_ARGUMENT, "release_others");
  ExpectError(Session(&Sessions::PullSession, "session_id: 'cube' pulls { body: 'cube' vertex: -1 }"),
              grpc::INVALID_ARGUMENT, "pulls[0].vertex: -1 is outside");
  ExpectError(Session(&Sessions::PullSession, "session_id: 'cube' pulls { body: 'cub' force { x: 1 } }"),
              grpc::INVALID_ARGUMENT, "pulls[0].body: there is no deformable body \"cub\"; there are cube");
  ExpectError(Session(&Sessions::PullSession, "session_id: 'cube' pulls { body: 'cube' force { x: nan } }"),
              grpc::INVALID_ARGUMENT, "pulls[0].force.x");
  ExpectError(Session(&Sessions::CreateSession,
                      "source { name: 'cube-springs' } pulls { body: 'cube' vertex: 6 force { x: 2e6 } }"),
              grpc::INVALID_ARGUMENT, "pulls[0].force");
}

TEST_F(SessionServiceTest, AnUnknownSceneIsNotFoundAndTheOthersAreNamed) {
  ExpectError(Session(&Sessions::CreateSession, "source { name: 'thorux' }"), grpc::NOT_FOUND, "cube-springs");
  ExpectError(Session(&Sessions::CreateSession, "source { }"), grpc::INVALID_ARGUMENT, "source");
  ExpectError(Session(&Sessions::CreateSession, ""), grpc::INVALID_ARGUMENT, "source");
}

TEST_F(SessionServiceTest, AMalformedSceneInTheRequestIsRefusedWithItsField) {
  const auto create = [&](const std::string& scene) {
    return Session(&Sessions::CreateSession, "source { scene { name: 'mine' " + scene + " } }");
  };
  const std::string point = "polyhedron { vertices { } vertices { x: 1 } edges { a: 0 b: 1 } }";
  const std::string body = "bodies { name: 'b' role: ROLE_DEFORMABLE ";
  ExpectError(create(""), grpc::INVALID_ARGUMENT, "bodies");
  ExpectError(create(body + "mass: -1 " + point + " }"), grpc::INVALID_ARGUMENT, "bodies[0].mass: -1");
  ExpectError(create(body + "polyhedron { vertices { } edges { a: 0 b: 9 } } }"), grpc::INVALID_ARGUMENT, "9");
  ExpectError(create(body + point + " } forces { springs { bodies: 'lnug' } }"), grpc::INVALID_ARGUMENT, "lnug");
  ExpectError(create(body + "file { path: '../../etc/passwd' } }"), grpc::NOT_FOUND, "--data");
  v1::ListSessionsResponse listed;
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListSessions, "", &listed).ok());
  EXPECT_EQ(listed.sessions_size(), 0) << "a session that could not be created is listed";
}

TEST_F(SessionServiceTest, StaleRevisionsAndTicksAreAborted) {
  CreateCube("cube");
  ExpectError(
      Session(&Sessions::UpdateParameters, "session_id: 'cube' parameters { elasticity: 2 } expected_revision: 9"),
      grpc::ABORTED, "expected_revision: 9");
  ExpectError(Session(&Sessions::StepSession, "session_id: 'cube' ticks: 1 expected_tick: 5"), grpc::ABORTED,
              "expected_tick: 5");
}

TEST_F(SessionServiceTest, MoreSessionsThanAllowedAreRefused) {
  for (int i = 0; i < 6; ++i) CreateCube(absl::StrCat("cube-", i));
  ExpectError(Session(&Sessions::CreateSession, "source { name: 'cube-springs' }"), grpc::RESOURCE_EXHAUSTED,
              "no more are allowed");
}

TEST_F(SessionServiceTest, SessionsOfOneSceneGiveEqualSteps) {
  CreateCube("a");
  CreateCube("b");
  Watch watch(NewChannel(), "b");
  v1::StepSessionResponse a, b;
  ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'a' ticks: 500", &a).ok());
  ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'b' ticks: 500", &b).ok());
  EXPECT_EQ(a.state_hash(), b.state_hash());
  EXPECT_FALSE(a.state_hash().empty());
}

TEST_F(SessionServiceTest, CancellingACallEndsItsSteps) {
  CreateCube("cube");
  v1::StepSessionRequest request;
  request.set_session_id("cube");
  request.set_ticks(1'000'000);
  v1::StepSessionResponse response;
  grpc::ClientContext context;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    context.TryCancel();
  });
  const grpc::Status status = sessions_->StepSession(&context, request, &response);
  canceller.join();
  if (status.ok()) GTEST_SKIP() << "this machine takes a million steps in 50 ms";
  EXPECT_EQ(status.error_code(), grpc::CANCELLED);
  bool free = false;
  for (int i = 0; i < 100 && !free; ++i) {
    free = Session(&Sessions::StepSession, "session_id: 'cube' ticks: 1").ok();
    if (!free) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(free) << "the steps continue without a caller";
}

TEST_F(SessionServiceTest, SessionsArePaged) {
  for (const char* id : {"a", "b", "c"}) CreateCube(id);
  v1::ListSessionsResponse first, second;
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListSessions, "page_size: 2", &first).ok());
  ASSERT_EQ(first.sessions_size(), 2);
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListSessions,
                   absl::StrCat("page_size: 2 page_token: '", first.next_page_token(), "'"), &second)
                  .ok());
  ASSERT_EQ(second.sessions_size(), 1);
  EXPECT_EQ(second.sessions(0).id(), "c");
  EXPECT_TRUE(second.next_page_token().empty());
}

TEST_F(SessionServiceTest, ScenesAreListedAndDescribed) {
  v1::ListScenesResponse listed;
  ASSERT_TRUE(Call(*scenes_, &v1::SceneService::Stub::ListScenes, "", &listed).ok());
  std::vector<std::string> names;
  for (const auto& scene : listed.scenes()) names.push_back(scene.name());
  EXPECT_THAT(names, testing::IsSupersetOf({"cube-springs", "cube-tensegrity", "sheet-2d"}));
  v1::DescribeSceneResponse described;
  ASSERT_TRUE(
      Call(*scenes_, &v1::SceneService::Stub::DescribeScene, "source { name: 'cube-tensegrity' }", &described).ok());
  EXPECT_GT(described.report().rigid_links(), 0);
  EXPECT_GT(described.report().stable_step().seconds(), 0);
  EXPECT_TRUE(described.parameters().has_time_step());
}

TEST_F(SessionServiceTest, ARequestThatIsTooLargeIsRefused) {
  v1::CreateSessionRequest request;
  request.mutable_source()->mutable_scene()->set_description(std::string(20 << 20, 'x'));
  v1::CreateSessionResponse response;
  grpc::ClientContext context;
  EXPECT_EQ(sessions_->CreateSession(&context, request, &response).error_code(), grpc::RESOURCE_EXHAUSTED);
  CreateCube("cube");
}

}  // namespace
}  // namespace phrenic::service
