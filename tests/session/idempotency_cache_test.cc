#include "server/session/idempotency_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"

namespace phrenic::session {
namespace {

TEST(IdempotencyCache, ARepeatGetsTheSameAnswer) {
  IdempotencyCache answers;
  const auto first = answers.Begin("a", "step 5");
  ASSERT_TRUE(first.ok());
  EXPECT_FALSE(first->has_value());
  answers.Keep("a", {absl::OkStatus(), "tick 5"});
  const auto second = answers.Begin("a", "step 5");
  ASSERT_TRUE(second.ok() && second->has_value());
  EXPECT_EQ((*second)->bytes, "tick 5");
}

TEST(IdempotencyCache, AnotherContentUnderTheSameIdIsRefused) {
  IdempotencyCache answers;
  ASSERT_TRUE(answers.Begin("a", "step 5").ok());
  answers.Keep("a", {});
  EXPECT_TRUE(absl::IsInvalidArgument(answers.Begin("a", "step 6").status()));
  EXPECT_TRUE(absl::IsInvalidArgument(answers.Begin("A b", "step 6").status())) << "this is no id";
}

TEST(IdempotencyCache, AForgottenRequestIsExecutedAgain) {
  IdempotencyCache answers;
  ASSERT_TRUE(answers.Begin("a", "step 5").ok());
  answers.Forget("a");
  EXPECT_FALSE(answers.Begin("a", "step 6")->has_value());
}

TEST(IdempotencyCache, TheNumberOfAnswersIsBounded) {
  IdempotencyCache answers;
  for (std::size_t i = 0; i <= kMostAnswers; ++i) {
    ASSERT_TRUE(answers.Begin(absl::StrCat(i), "").ok());
    answers.Keep(absl::StrCat(i), {});
  }
  EXPECT_TRUE(answers.Begin("1", "")->has_value());
  EXPECT_FALSE(answers.Begin("0", "")->has_value());
}

TEST(IdempotencyCache, ConcurrentRepeatsAreExecutedOnceAndGetOneAnswer) {
  IdempotencyCache answers;
  std::atomic<int> carried_out = 0, answered = 0;
  std::vector<std::thread> callers;
  for (int i = 0; i < 8; ++i) {
    callers.emplace_back([&] {
      const auto before = answers.Begin("a", "step 5");
      if (before.ok() && before->has_value()) {
        answered += (*before)->bytes == "done";
        return;
      }
      ++carried_out;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      answers.Keep("a", {absl::OkStatus(), "done"});
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(carried_out, 1);
  EXPECT_EQ(answered, 7);
}

}  // namespace
}  // namespace phrenic::session
