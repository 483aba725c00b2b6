#include "server/session/classroom/answer_book.h"

#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "absl/strings/str_cat.h"

namespace phrenic::session {
namespace {

using testing::HasSubstr;

// Returns an answer of the respondent of this number to a question of the lesson "paralysis".
v1::SubmitAnswerRequest AnswerOf(int who, int choice, bool right, int step = 2) {
  v1::SubmitAnswerRequest request;
  request.set_session_id("class");
  request.set_respondent(absl::StrCat("0123456789abcdef-", who));
  request.set_lesson("paralysis");
  request.set_step(step);
  request.add_choices(choice);
  request.set_right(right);
  return request;
}

TEST(AnswerBook, KeepsTheLastAnswerOfEachAndWhetherTheFirstWasRight) {
  AnswerBook book;
  EXPECT_EQ(*book.Submit(AnswerOf(1, 0, false)), 1);
  EXPECT_EQ(*book.Submit(AnswerOf(2, 1, true)), 1);
  EXPECT_EQ(*book.Submit(AnswerOf(1, 1, true)), 2);
  const v1::ListAnswersResponse all = book.List("", false);
  ASSERT_EQ(all.answers_size(), 2);
  EXPECT_EQ(all.respondents(), 2);
  EXPECT_EQ(all.answers(0).respondent(), 1);
  EXPECT_THAT(all.answers(0).choices(), testing::ElementsAre(1));
  EXPECT_TRUE(all.answers(0).right());
  EXPECT_FALSE(all.answers(0).first_right());
  EXPECT_EQ(all.answers(0).attempts(), 2);
  EXPECT_TRUE(all.answers(1).first_right());
}

TEST(AnswerBook, SeparatesLessonsStepsAndPhases) {
  AnswerBook book;
  v1::SubmitAnswerRequest answer = AnswerOf(1, 0, true);
  ASSERT_TRUE(book.Submit(answer).ok());
  for (const auto phase : {v1::ANSWER_PHASE_BEFORE, v1::ANSWER_PHASE_AFTER}) {
    answer.set_phase(phase);
    EXPECT_EQ(*book.Submit(answer), 1);
  }
  answer.set_lesson("copd");
  EXPECT_EQ(*book.Submit(answer), 1);
  EXPECT_EQ(*book.Submit(AnswerOf(1, 0, true, 4)), 1);
  EXPECT_EQ(book.List("", false).answers_size(), 5);
  EXPECT_EQ(book.List("paralysis", false).answers_size(), 4);
  EXPECT_EQ(book.List("nonsense", false).answers_size(), 0);
}

TEST(AnswerBook, NamesAreReturnedOnlyIfWantedAndSecretsNever) {
  AnswerBook book;
  v1::SubmitAnswerRequest answer = AnswerOf(1, 0, true);
  answer.set_name("Ben");
  ASSERT_TRUE(book.Submit(answer).ok());
  ASSERT_TRUE(book.Submit(AnswerOf(1, 0, true, 3)).ok()) << "keeps the name";
  EXPECT_EQ(book.List("", false).answers(0).name(), "");
  EXPECT_EQ(book.List("", true).answers(1).name(), "Ben");
  EXPECT_EQ(book.List("", true).DebugString().find("0123456789abcdef"), std::string::npos);
}

TEST(AnswerBook, RefusesWhatIsNoAnswerWithTheField) {
  AnswerBook book;
  const auto refusal = [&](v1::SubmitAnswerRequest answer) {
    const auto refused = book.Submit(answer);
    EXPECT_TRUE(absl::IsInvalidArgument(refused.status())) << refused.status();
    return std::string(refused.status().message());
  };
  v1::SubmitAnswerRequest answer = AnswerOf(1, 0, true);
  answer.set_respondent("short");
  EXPECT_THAT(refusal(answer), HasSubstr("respondent:"));
  answer = AnswerOf(1, 0, true);
  answer.set_lesson(std::string(81, 'x'));
  EXPECT_THAT(refusal(answer), HasSubstr("lesson:"));
  EXPECT_THAT(refusal(AnswerOf(1, -1, true)), HasSubstr("choices:"));
  EXPECT_THAT(refusal(AnswerOf(1, kMostChoices, true)), HasSubstr("choices:"));
  answer = AnswerOf(1, 0, true);
  answer.set_number(1);
  EXPECT_THAT(refusal(answer), HasSubstr("choices: give either"));
  answer.clear_choices();
  answer.set_number(std::nan(""));
  EXPECT_THAT(refusal(answer), HasSubstr("number:"));
  EXPECT_EQ(book.List("", false).respondents(), 0);
}

TEST(AnswerBook, IsBoundedAndBeginsAgainAfterClear) {
  AnswerBook book;
  for (int who = 1; who <= static_cast<int>(kMostRespondents); ++who)
    ASSERT_TRUE(book.Submit(AnswerOf(who, 0, true)).ok());
  EXPECT_TRUE(absl::IsResourceExhausted(book.Submit(AnswerOf(999, 0, true)).status()));
  EXPECT_TRUE(book.Submit(AnswerOf(7, 1, false)).ok()) << "a repeated answer needs no more room";
  std::size_t answers = kMostRespondents;
  for (int step = 3; answers < kMostClassAnswers; ++step) {
    for (int who = 1; who <= static_cast<int>(kMostRespondents); ++who, ++answers) {
      ASSERT_TRUE(book.Submit(AnswerOf(who, 0, true, step)).ok());
    }
  }
  EXPECT_TRUE(absl::IsResourceExhausted(book.Submit(AnswerOf(1, 0, true, 900)).status()));
  book.Clear();
  EXPECT_EQ(*book.Submit(AnswerOf(999, 0, true)), 1);
  EXPECT_EQ(book.List("", false).answers(0).respondent(), 1);
}

TEST(AnswerBook, OneSourceLeavesRoomForOthers) {
  AnswerBook book;
  const AnswerSource watcher{"192.0.2.1", 60}, pupil{"192.0.2.2", 60};
  for (int who = 1; who <= 60; ++who) ASSERT_TRUE(book.Submit(AnswerOf(who, 0, true), watcher).ok());
  const auto refused = book.Submit(AnswerOf(61, 0, true), watcher);
  EXPECT_TRUE(absl::IsResourceExhausted(refused.status()));
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("60 browsers of this account or address"));
  EXPECT_TRUE(book.Submit(AnswerOf(60, 1, false, 3), watcher).ok()) << "one that has answered before";
  EXPECT_TRUE(book.Submit(AnswerOf(100, 0, true), pupil).ok());
  book.Clear();
  EXPECT_TRUE(book.Submit(AnswerOf(61, 0, true), watcher).ok());
}

TEST(AnswerBook, OneRespondentCannotFillTheBook) {
  AnswerBook book;
  for (int step = 1; step <= static_cast<int>(kMostAnswersOfOne); ++step)
    ASSERT_TRUE(book.Submit(AnswerOf(1, 0, true, step)).ok());
  EXPECT_TRUE(absl::IsResourceExhausted(book.Submit(AnswerOf(1, 0, true, 900)).status()));
  EXPECT_TRUE(book.Submit(AnswerOf(1, 1, true, 1)).ok()) << "a repeated answer needs no more room";
  EXPECT_TRUE(book.Submit(AnswerOf(2, 0, true)).ok());
}

TEST(AnswerBook, AnswersOfManyThreadsAreAllCounted) {
  AnswerBook book;
  std::vector<std::thread> threads;
  for (int who = 1; who <= 4; ++who) {
    threads.emplace_back([&book, who] {
      for (int i = 0; i < 100; ++i) EXPECT_TRUE(book.Submit(AnswerOf(who, 0, true)).ok());
    });
  }
  for (std::thread& thread : threads) thread.join();
  const v1::ListAnswersResponse all = book.List("", false);
  ASSERT_EQ(all.answers_size(), 4);
  for (const v1::ClassAnswer& answer : all.answers()) EXPECT_EQ(answer.attempts(), 100);
}

}  // namespace
}  // namespace phrenic::session
