#include "server/lti/grading.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "tests/lti/example.h"

namespace phrenic::lti {
namespace {

// A lesson of a folder of its own, and outboxes that keep all parcels.
class GradingTest : public testing::Test {
 protected:
  GradingTest() {
    std::filesystem::create_directories(folder_);
    Write(R"({"steps":[{"question":{"number":{"value":1}}},{"question":{"number":{"value":2}}}]})");
  }
  ~GradingTest() override { std::filesystem::remove_all(folder_); }

  void Write(const std::string& lesson) { std::ofstream(folder_ + "/short.json") << lesson; }
  void Enter() {
    Launch launch;
    launch.user = "user-7";
    launch.lesson = "short";
    launch.line_item = "https://school.example/items/3";
    respondent_ = grading_.Enter(ExamplePlatform(), launch, "course", "session", kExampleNow);
  }
  void Answer(int step, double number) {
    v1::SubmitAnswerRequest answer;
    answer.set_session_id("session");
    answer.set_respondent(respondent_);
    answer.set_lesson("short");
    answer.set_step(step);
    answer.set_number(number);
    grading_.Answered(answer, kExampleNow);
  }
  // Waits for a score.
  bool Arrives() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    const auto arrived = [this]() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return !sent_.empty(); };
    return mutex_.AwaitWithTimeout(absl::Condition(&arrived), absl::Seconds(5));
  }
  static absl::Status Keep(const Parcel&) { return absl::UnavailableError("away"); }

  const std::string folder_ = absl::StrCat(testing::TempDir(), "/phrenic-grading-", getpid());
  const Lessons lessons_{folder_};
  Outbox statements_{Keep, {"test", nullptr}};
  absl::Mutex mutex_;
  std::vector<nlohmann::json> sent_ ABSL_GUARDED_BY(mutex_);
  Outbox scores_{[this](const Parcel& parcel) {
                   absl::MutexLock lock(&mutex_);
                   sent_.push_back(parcel.content);
                   return absl::OkStatus();
                 },
                 {"test", nullptr}};
  Grading grading_{{kExampleUrl, &lessons_, &scores_, &statements_}, {"test", nullptr}};
  std::string respondent_;
};

TEST_F(GradingTest, NoScoreIsAboveTheQuestionsOfThePresentLesson) {
  Enter();
  Answer(1, 1);
  Write(R"({"title":"New","steps":[{},{"question":{"number":{"value":2}}},{"question":{"number":{"value":3}}}]})");
  Answer(2, 2);
  for (int i = 0; i < 20; ++i) absl::SleepFor(absl::Milliseconds(10));
  EXPECT_EQ(scores_.size(), 0U);
  {
    absl::MutexLock lock(&mutex_);
    EXPECT_TRUE(sent_.empty());  // two answers are kept, but the third step has none
  }
  Answer(3, 3);
  absl::MutexLock lock(&mutex_);
  ASSERT_TRUE(Arrives());
  EXPECT_EQ(sent_.back()["scoreGiven"], 2);
  EXPECT_EQ(sent_.back()["scoreMaximum"], 2);
}

// Learners may not play the breath, so that a predicted curve can stay without an answer.
TEST_F(GradingTest, APredictedCurveDoesNotCount) {
  Write(R"({"steps":[{"question":{"number":{"value":1}}},
                     {"question":{"prediction":{"measure":"lung volume","tolerance":0.2}}}]})");
  Enter();
  Answer(1, 1);
  const std::size_t stated = statements_.size();
  {
    absl::MutexLock lock(&mutex_);
    ASSERT_TRUE(Arrives());
    EXPECT_EQ(sent_.back()["scoreGiven"], 1);
    EXPECT_EQ(sent_.back()["scoreMaximum"], 1);
  }
  Answer(2, 0.1);
  EXPECT_EQ(statements_.size(), stated + 1) << "the answer alone is stated, no score again";
  absl::MutexLock lock(&mutex_);
  EXPECT_EQ(sent_.size(), 1U);
}

TEST_F(GradingTest, ARepeatedAnswerIsStatedOnce) {
  Enter();
  const std::size_t before = statements_.size();
  for (int i = 0; i < 100; ++i) Answer(1, 7);
  EXPECT_EQ(statements_.size(), before + 1);
  Answer(1, 8);  // as wrong as the one before, but another
  EXPECT_EQ(statements_.size(), before + 2);
}

TEST_F(GradingTest, ALearnerIsLaunchedIntoOneSession) {
  Enter();
  EXPECT_TRUE(grading_.Launched("session", respondent_));
  EXPECT_FALSE(grading_.Launched("another", respondent_));
  EXPECT_FALSE(grading_.Launched("session", ""));
}

}  // namespace
}  // namespace phrenic::lti
