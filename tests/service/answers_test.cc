// A class answers a lesson's questions over the wire, and who may read the answers.
#include "tests/service/guarded_server.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using Sessions = v1::SessionService::Stub;

constexpr char kAnswer[] = "respondent: '0123456789abcdef' lesson: 'copd' step: 2 choices: 1 right: true name: 'Ben' ";

class ClassAnswersTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    v1::CreateSessionResponse created;
    const auto status = Call(*sessions_, &Sessions::CreateSession,
                             "session_id: 'class' source { name: 'cube-springs' } control: CONTROL_POLICY_OWNER "
                             "owner_name: 'Anna'",
                             &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
    anna_ = absl::StrCat("session_id: 'class' control_token: '", created.control_token(), "' ");
  }

  std::string anna_;
};

TEST_F(ClassAnswersTest, APupilAnswersAndOnlyTheTeacherReads) {
  v1::SubmitAnswerResponse submitted;
  ASSERT_TRUE(
      Call(*sessions_, &Sessions::SubmitAnswer, absl::StrCat("session_id: 'class' ", kAnswer), &submitted).ok());
  EXPECT_EQ(submitted.attempts(), 1);
  v1::ListAnswersResponse listed;
  EXPECT_EQ(Call(*sessions_, &Sessions::ListAnswers, "session_id: 'class'", &listed).error_code(),
            grpc::PERMISSION_DENIED);
  v1::DeleteAnswersResponse deleted;
  EXPECT_EQ(Call(*sessions_, &Sessions::DeleteAnswers, "session_id: 'class'", &deleted).error_code(),
            grpc::PERMISSION_DENIED);
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListAnswers, anna_, &listed).ok());
  ASSERT_EQ(listed.answers_size(), 1);
  EXPECT_EQ(listed.answers(0).name(), "");
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListAnswers, anna_ + "include_names: true lesson: 'copd'", &listed).ok());
  EXPECT_EQ(listed.answers(0).name(), "Ben");
  ASSERT_TRUE(Call(*sessions_, &Sessions::DeleteAnswers, anna_, &deleted).ok());
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListAnswers, anna_, &listed).ok());
  EXPECT_EQ(listed.answers_size(), 0);
}

TEST_F(ClassAnswersTest, NamesAndDeletionAreForWhoControlsAlone) {
  v1::SubmitAnswerResponse submitted;
  ASSERT_TRUE(
      Call(*sessions_, &Sessions::SubmitAnswer, absl::StrCat("session_id: 'class' ", kAnswer), &submitted).ok());
  v1::HandControlResponse handed;
  ASSERT_TRUE(Call(*control_, &v1::ControlService::Stub::HandControl, anna_ + "everybody: true", &handed).ok());
  v1::ListAnswersResponse listed;
  EXPECT_TRUE(Call(*sessions_, &Sessions::ListAnswers, "session_id: 'class'", &listed).ok());
  const auto refused = Call(*sessions_, &Sessions::ListAnswers, "session_id: 'class' include_names: true", &listed);
  EXPECT_EQ(refused.error_code(), grpc::PERMISSION_DENIED);
  EXPECT_THAT(refused.error_message(), HasSubstr("take control first"));
  v1::DeleteAnswersResponse deleted;
  EXPECT_EQ(Call(*sessions_, &Sessions::DeleteAnswers, "session_id: 'class'", &deleted).error_code(),
            grpc::PERMISSION_DENIED)
      << "a pupil could delete the class's answers";
  ASSERT_TRUE(Call(*sessions_, &Sessions::ListAnswers, "session_id: 'class'", &listed).ok());
  EXPECT_EQ(listed.answers_size(), 1);
}

TEST_F(ClassAnswersTest, ErrorsNameTheFieldOrTheSession) {
  v1::SubmitAnswerResponse submitted;
  const auto refused = [&](const std::string& text) {
    return Call(*sessions_, &Sessions::SubmitAnswer, text, &submitted);
  };
  EXPECT_EQ(refused(absl::StrCat("session_id: 'none' ", kAnswer)).error_code(), grpc::NOT_FOUND);
  const auto without_step = refused("session_id: 'class' respondent: '0123456789abcdef' lesson: 'copd' choices: 1");
  EXPECT_EQ(without_step.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(without_step.error_message(), HasSubstr("step"));
  const auto long_name =
      refused(absl::StrCat("session_id: 'class' respondent: '0123456789abcdef' lesson: 'copd' step: 1 ",
                           "choices: 1 name: '", std::string(50, 'n'), "'"));
  EXPECT_EQ(long_name.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(long_name.error_message(), HasSubstr("name: a name has 1 to 40"));
}

TEST_F(GuardedServer, ALinkForWatchingIsEnoughToAnswerAndNotToReadAnswers) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  const As pupil{"", Link("").secret()};
  EXPECT_EQ(Code(pupil, &Sessions::SubmitAnswer, absl::StrCat("session_id: 'mine' ", kAnswer)), grpc::OK);
  EXPECT_EQ(Code(pupil, &Sessions::ListAnswers, "session_id: 'mine'"), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Code(pupil, &Sessions::DeleteAnswers, "session_id: 'mine'"), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Code({"other"}, &Sessions::SubmitAnswer, absl::StrCat("session_id: 'mine' ", kAnswer)), grpc::NOT_FOUND);
  EXPECT_EQ(Code({"owner"}, &Sessions::ListAnswers, "session_id: 'mine'"), grpc::OK) << "without a control token";
  EXPECT_EQ(Code({"owner"}, &Sessions::DeleteAnswers, "session_id: 'mine'"), grpc::OK);
}

}  // namespace
}  // namespace phrenic::service
