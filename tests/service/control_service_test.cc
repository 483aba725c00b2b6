#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using testing::Not;
using Sessions = v1::SessionService::Stub;
using Controls = v1::ControlService::Stub;

class ControlServiceTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    v1::CreateSessionResponse created;
    const auto status = Call(*sessions_, &Sessions::CreateSession,
                             "session_id: 'class' source { name: 'cube-springs' } control: CONTROL_POLICY_OWNER "
                             "owner_name: 'Anna'",
                             &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
    anna_ = created.control_token();
    v1::EnterSessionResponse entered;
    ASSERT_TRUE(Call(*control_, &Controls::EnterSession, "session_id: 'class' name: 'Ben'", &entered).ok());
    ben_ = entered.control_token();
  }
  template <class Request, class Response>
  grpc::Status Control(grpc::Status (Controls::*method)(grpc::ClientContext*, const Request&, Response*),
                       const std::string& token, const std::string& more = "") {
    Response response;
    return Call(*control_, method, absl::StrCat("session_id: 'class' control_token: '", token, "' ", more), &response);
  }
  grpc::Status Step(const std::string& token, const std::string& more = "") {
    return Call(*sessions_, &Sessions::StepSession,
                absl::StrCat("session_id: 'class' ticks: 5 control_token: '", token, "' ", more), &stepped_);
  }

  std::string anna_, ben_;
  v1::StepSessionResponse stepped_;
};

TEST_F(ControlServiceTest, ControlIsHandedOverRefusedAndTakenBack) {
  EXPECT_TRUE(Step(anna_).ok());
  const grpc::Status refused = Step(ben_);
  EXPECT_EQ(refused.error_code(), grpc::PERMISSION_DENIED);
  EXPECT_THAT(refused.error_message(), HasSubstr("controlled by Anna"));
  ASSERT_TRUE(Control(&Controls::HandControl, anna_, "name: 'Ben'").ok());
  EXPECT_TRUE(Step(ben_).ok());
  EXPECT_EQ(Step(anna_).error_code(), grpc::PERMISSION_DENIED);
  ASSERT_TRUE(Control(&Controls::TakeControl, anna_).ok());
  EXPECT_EQ(Step(ben_).error_code(), grpc::PERMISSION_DENIED);
  ASSERT_TRUE(Control(&Controls::HandControl, anna_, "everybody: true").ok());
  EXPECT_TRUE(Step("").ok());
}

TEST_F(ControlServiceTest, EveryCallThatChangesTheSessionIsRefusedToOthers) {
  for (const std::string& token : {std::string(), ben_, anna_.substr(1)}) {
    const std::string who = absl::StrCat("session_id: 'class' control_token: '", token, "' ");
    EXPECT_EQ(Session(&Sessions::PlaySession, who).error_code(), grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::PauseSession, who).error_code(), grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::StepSession, who + "ticks: 1").error_code(), grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::ResetSession, who).error_code(), grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::UpdateParameters, who + "parameters { elasticity: 2 }").error_code(),
              grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::PullSession, who + "release_others: true").error_code(), grpc::PERMISSION_DENIED);
    EXPECT_EQ(Session(&Sessions::DeleteSession, who).error_code(), grpc::PERMISSION_DENIED);
    if (token.empty()) continue;  // a caller without a token has no camera
    EXPECT_EQ(Control(&Controls::ShowCamera, token, "camera { eye { x: 1 } target { } }").error_code(),
              grpc::PERMISSION_DENIED);
  }
  EXPECT_TRUE(Session(&Sessions::ForkSession, "session_id: 'class' fork_id: 'own'").ok()) << "every caller may fork";
  EXPECT_TRUE(Session(&Sessions::StepSession, "session_id: 'own' ticks: 1").ok());
  EXPECT_TRUE(Session(&Sessions::DeleteSession, absl::StrCat("session_id: 'class' control_token: '", anna_, "'")).ok());
}

TEST_F(ControlServiceTest, ResponsesAndStreamsContainNoToken) {
  ASSERT_TRUE(Control(&Controls::HandControl, anna_, "name: 'Ben'").ok());
  v1::GetSessionResponse got;
  ASSERT_TRUE(Call(*sessions_, &Sessions::GetSession, "session_id: 'class'", &got).ok());
  EXPECT_EQ(got.session().control().controller(), "Ben");
  Watch watch(NewChannel(), "class");
  v1::WatchFramesResponse told;
  ASSERT_TRUE(watch.ReadUntil([](const auto& response) { return response.has_session(); }, &told));
  EXPECT_EQ(told.session().control().controller(), "Ben");
  for (const std::string& text : {got.DebugString(), told.DebugString(), Step("").error_message()}) {
    EXPECT_THAT(text, Not(HasSubstr(anna_)));
    EXPECT_THAT(text, Not(HasSubstr(ben_)));
  }
}

TEST_F(ControlServiceTest, ViewersReceiveHandOversAndTheCamera) {
  Watch watch(NewChannel(), "class");
  v1::WatchFramesResponse told;
  ASSERT_TRUE(Control(&Controls::ShowCamera, anna_, "camera { eye { x: 1 y: 2 } target { z: 3 } }").ok());
  ASSERT_TRUE(watch.ReadUntil([](const auto& response) { return response.has_camera(); }, &told));
  EXPECT_EQ(told.camera().eye().y(), 2);
  ASSERT_TRUE(Control(&Controls::HandControl, anna_, "name: 'Ben'").ok());
  EXPECT_TRUE(
      watch.ReadUntil([](const auto& response) { return response.session().control().controller() == "Ben"; }, &told));
}

TEST_F(ControlServiceTest, BadRequestsNameTheirFieldAndTheRemedy) {
  const auto expect = [](const grpc::Status& status, grpc::StatusCode code, const std::string& part) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(part));
  };
  expect(Control(&Controls::EnterSession, "", "name: ''"), grpc::INVALID_ARGUMENT, "name: a name has 1 to 40");
  expect(Control(&Controls::EnterSession, "", "name: 'x' time_to_live: 4000"), grpc::INVALID_ARGUMENT, "time_to_live");
  expect(Control(&Controls::EnterSession, "", "name: 'Ben'"), grpc::ALREADY_EXISTS, "enter under another name");
  expect(Control(&Controls::TakeControl, "made-up"), grpc::PERMISSION_DENIED, "EnterSession");
  expect(Control(&Controls::HandControl, anna_), grpc::INVALID_ARGUMENT, "to: name who gets control");
  expect(Control(&Controls::HandControl, anna_, "name: 'Cleo'"), grpc::FAILED_PRECONDITION, "no one has entered");
  expect(Control(&Controls::ShowCamera, anna_, "camera { eye { x: nan } target { } }"), grpc::INVALID_ARGUMENT,
         "camera.eye.x");
  expect(Session(&Sessions::CreateSession, "source { name: 'cube-springs' } owner_name: ' Anna'"),
         grpc::INVALID_ARGUMENT, "owner_name");
}

TEST_F(ControlServiceTest, ARepeatedRequestTakesEffectOnce) {
  ASSERT_TRUE(Step(anna_, "request_id: 'first'").ok());
  const std::string once = stepped_.SerializeAsString();
  ASSERT_TRUE(Step(anna_, "request_id: 'first'").ok());
  EXPECT_EQ(stepped_.SerializeAsString(), once);
  EXPECT_EQ(stepped_.session().tick(), 5);
  ASSERT_TRUE(Step(anna_, "request_id: 'second'").ok());
  EXPECT_EQ(stepped_.session().tick(), 10);
  const grpc::Status other = Step(anna_, "request_id: 'first' expected_tick: 10");
  EXPECT_EQ(other.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(other.error_message(), HasSubstr("request_id: first belongs to another request"));
  EXPECT_EQ(Step(ben_, "request_id: 'second'").error_code(), grpc::INVALID_ARGUMENT)
      << "another client's response was returned";
}

TEST_F(ControlServiceTest, ARefusedRequestCanBeRepeatedOnceItIsAllowed) {
  EXPECT_EQ(Step(ben_, "request_id: 'mine'").error_code(), grpc::PERMISSION_DENIED);
  ASSERT_TRUE(Control(&Controls::HandControl, anna_, "name: 'Ben'").ok());
  EXPECT_TRUE(Step(ben_, "request_id: 'mine'").ok());
  EXPECT_EQ(stepped_.session().tick(), 5);
}

TEST_F(ControlServiceTest, StepsContinueWithoutTheirCallerAndARepeatGetsTheResult) {
  v1::StepSessionRequest request;
  request.set_session_id("class");
  request.set_ticks(200'000);
  request.set_control_token(anna_);
  request.set_request_id("long");
  v1::StepSessionResponse response;
  grpc::ClientContext short_of_time, patient;
  short_of_time.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(1));
  EXPECT_EQ(sessions_->StepSession(&short_of_time, request, &response).error_code(), grpc::DEADLINE_EXCEEDED);
  const grpc::Status done = sessions_->StepSession(&patient, request, &response);
  EXPECT_TRUE(done.ok()) << done.error_message();
  EXPECT_EQ(response.session().tick(), 200'000);
}

TEST_F(ControlServiceTest, UpdatesForAPastTickAreRefused) {
  const auto update = [&](int tick) {
    return Session(&Sessions::UpdateParameters,
                   absl::StrCat("session_id: 'class' control_token: '", anna_, "' parameters { elasticity: 2 } ",
                                "apply_at_tick: ", tick));
  };
  EXPECT_TRUE(update(7).ok());
  ASSERT_TRUE(Step(anna_).ok());
  EXPECT_EQ(stepped_.session().waiting_updates(), 1);
  EXPECT_EQ(stepped_.session().parameters().elasticity(), 1);
  ASSERT_TRUE(Step(anna_).ok());
  EXPECT_EQ(stepped_.session().parameters().elasticity(), 2);
  EXPECT_EQ(update(9).error_code(), grpc::FAILED_PRECONDITION);
}

class ManySessionsTest : public ServerFixture {
 protected:
  ManySessionsTest() { options_.limits.sessions = 1000; }
};

// One client steps a thousand sessions in parallel: each reaches the state of a single session.
TEST_F(ManySessionsTest, AThousandSmallSessionsAreSteppedByOneClient) {
  constexpr int kSessions = 1000, kRounds = 2;
  for (int i = 0; i < kSessions; ++i) CreateCube(absl::StrCat("cube-", i));
  std::string hash;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kSessions; ++i) {
      v1::StepSessionResponse stepped;
      const std::string request =
          absl::StrCat("session_id: 'cube-", i, "' ticks: 4 expected_tick: ", 4 * round, " request_id: 'r", round, "'");
      const grpc::Status status = Call(*sessions_, &Sessions::StepSession, request, &stepped);
      ASSERT_TRUE(status.ok()) << status.error_message();
      if (i == 0) hash = stepped.state_hash();
      ASSERT_EQ(stepped.state_hash(), hash) << "session " << i << " in round " << round;
    }
  }
  v1::StepSessionResponse alone;
  ASSERT_TRUE(Session(&Sessions::DeleteSession, "session_id: 'cube-999'").ok());
  CreateCube("alone");
  ASSERT_TRUE(Call(*sessions_, &Sessions::StepSession, "session_id: 'alone' ticks: 8", &alone).ok());
  EXPECT_EQ(alone.state_hash(), hash);
}

}  // namespace
}  // namespace phrenic::service
