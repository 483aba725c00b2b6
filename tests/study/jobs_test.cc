#include "server/study/jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/synchronization/notification.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;

Jobs::Seen WaitForEnd(const Jobs& jobs, const std::string& id) {
  Jobs::Seen seen;
  while (!seen.ended) {
    auto next = jobs.Wait(id, seen.version, absl::Seconds(10));
    EXPECT_TRUE(next.ok()) << next.status();
    if (!next.ok()) break;
    seen = *std::move(next);
  }
  return seen;
}

Jobs::Work Named(const std::string& scene) {
  return [scene](const Progress& progress) -> absl::StatusOr<v1::StudyResult> {
    progress(0.5, "halfway");
    v1::StudyResult result;
    result.set_scene(scene);
    return result;
  };
}

// Runs until it is asked to end.
absl::StatusOr<v1::StudyResult> Endless(const Progress& progress) {
  while (progress(0.1, "waiting")) absl::SleepFor(absl::Milliseconds(1));
  return Cancelled();
}

TEST(Jobs, RunAndKeepTheirResults) {
  Jobs jobs(4);
  const auto study = jobs.Add("", "error", "thorax", Named("thorax"));
  ASSERT_TRUE(study.ok()) << study.status();
  EXPECT_EQ(study->id(), "error-thorax");
  const Jobs::Seen seen = WaitForEnd(jobs, study->id());
  EXPECT_EQ(seen.study.state(), v1::STUDY_STATE_DONE);
  EXPECT_EQ(seen.study.progress(), 1);
  EXPECT_EQ(seen.study.result().scene(), "thorax");
  ASSERT_EQ(jobs.List().size(), 1);
  EXPECT_FALSE(jobs.List()[0].has_result());
}

TEST(Jobs, SayWhyTheyFailed) {
  Jobs jobs(4);
  const auto fails = [](const Progress&) -> absl::StatusOr<v1::StudyResult> {
    return absl::OutOfRangeError("the breath diverged");
  };
  ASSERT_TRUE(jobs.Add("a", "error", "thorax", fails).ok());
  const Jobs::Seen seen = WaitForEnd(jobs, "a");
  EXPECT_EQ(seen.study.state(), v1::STUDY_STATE_FAILED);
  EXPECT_EQ(seen.study.problem(), "the breath diverged");
}

TEST(Jobs, RunOneAfterTheOther) {
  Jobs jobs(4);
  std::atomic<int> running = 0, most = 0;
  const auto counts = [&](const Progress&) -> absl::StatusOr<v1::StudyResult> {
    most = std::max(most.load(), ++running);
    absl::SleepFor(absl::Milliseconds(5));
    --running;
    return v1::StudyResult();
  };
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(jobs.Add("", "cost", "cube", counts).ok());
  WaitForEnd(jobs, "cost-cube-4");
  EXPECT_EQ(most, 1);
}

TEST(Jobs, DeletedEndAndTellTheirWatchers) {
  Jobs jobs(4);
  ASSERT_TRUE(jobs.Add("long", "error", "thorax", &Endless).ok());
  ASSERT_TRUE(jobs.Delete("long").ok());
  EXPECT_EQ(jobs.Wait("long", 0, absl::ZeroDuration()).status().code(), absl::StatusCode::kNotFound);
  // The next one gets its turn.
  ASSERT_TRUE(jobs.Add("next", "error", "cube", Named("cube")).ok());
  EXPECT_EQ(WaitForEnd(jobs, "next").study.state(), v1::STUDY_STATE_DONE);
}

TEST(Jobs, AreBounded) {
  Jobs jobs(2);
  ASSERT_TRUE(jobs.Add("a", "error", "thorax", &Endless).ok());
  ASSERT_TRUE(jobs.Add("b", "error", "thorax", &Endless).ok());
  const auto refused = jobs.Add("c", "error", "thorax", &Endless);
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("delete one"));
}

TEST(Jobs, TheOldestThatEndedMakesRoom) {
  Jobs jobs(1);
  ASSERT_TRUE(jobs.Add("a", "error", "cube", Named("cube")).ok());
  WaitForEnd(jobs, "a");
  ASSERT_TRUE(jobs.Add("b", "error", "cube", Named("cube")).ok());
  EXPECT_EQ(jobs.Wait("a", 0, absl::ZeroDuration()).status().code(), absl::StatusCode::kNotFound);
}

TEST(Jobs, RefuseBadAndTakenNames) {
  Jobs jobs(4);
  EXPECT_EQ(jobs.Add("No Good", "error", "cube", Named("cube")).status().code(), absl::StatusCode::kInvalidArgument);
  ASSERT_TRUE(jobs.Add("a", "error", "cube", Named("cube")).ok());
  EXPECT_EQ(jobs.Add("a", "error", "cube", Named("cube")).status().code(), absl::StatusCode::kAlreadyExists);
  EXPECT_THAT(std::string(jobs.Delete("b").message()), HasSubstr("there are a"));
}

TEST(Jobs, EndWithTheirTable) {
  const auto jobs = std::make_unique<Jobs>(4);
  ASSERT_TRUE(jobs->Add("a", "error", "thorax", &Endless).ok());
  ASSERT_TRUE(jobs->Add("b", "error", "thorax", &Endless).ok());
}  // nothing hangs

}  // namespace
}  // namespace phrenic::study
