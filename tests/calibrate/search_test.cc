// The search finds numbers at which deviations vanish, inside the bounds, in the same way each time.
#include "server/calibrate/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace phrenic::calibrate {
namespace {

// A curved, coupled pair of measures of two numbers, of which the first has a twentieth of the second's size.
Numbers Measured(std::span<const double> x) {
  const double a = 6 * x[0] / (1 + 8 * x[0]), b = 1.2 * x[1] / (1 + x[1]);
  return {a + b, (a - 0.3 * b) / (a + b)};
}

class SearchOfTwo : public testing::Test {
 protected:
  // Searches for the point whose measures are those of `goal`.
  absl::StatusOr<Nearest> To(const Numbers& goal) {
    const Numbers wanted = Measured(goal);
    return Search(space_, limits_, [&](std::span<const double> x) -> absl::StatusOr<Numbers> {
      tried_.emplace_back(x.begin(), x.end());
      const Numbers got = Measured(x);
      return Numbers{got[0] / wanted[0] - 1, got[1] / wanted[1] - 1};
    });
  }

  SearchSpace space_{{0, 0}, {5, 10}, {0.08, 0.9}, {0.02, 0.2}};
  SearchLimits limits_{0.001, 60};
  std::vector<Numbers> tried_;
};

TEST_F(SearchOfTwo, RecoversANearAndAFarPoint) {
  for (const Numbers& goal : {Numbers{0.07, 1.1}, Numbers{0.2, 0.5}}) {
    const auto found = To(goal);
    ASSERT_TRUE(found.ok()) << found.status();
    EXPECT_EQ(found->end, Nearest::End::kReached);
    EXPECT_LE(found->largest, 0.001);
    EXPECT_NEAR(found->at[0], goal[0], 0.01 * goal[0]);
    EXPECT_NEAR(found->at[1], goal[1], 0.01 * goal[1]);
  }
}

TEST_F(SearchOfTwo, RepeatsItselfBitForBitAndTriesNoPointTwice) {
  const auto first = To({0.2, 0.5});
  const auto points = std::exchange(tried_, {});
  EXPECT_EQ(std::set(points.begin(), points.end()).size(), points.size());
  const auto second = To({0.2, 0.5});
  EXPECT_EQ(points, tried_);
  EXPECT_EQ(first->at, second->at);
  EXPECT_EQ(first->deviations, second->deviations);
  EXPECT_EQ(first->tries, static_cast<int>(points.size()));
}

TEST_F(SearchOfTwo, StaysInsideTheBoundsAndStopsAtTheOneThatIsInTheWay) {
  space_.high[0] = 0.1;
  const auto found = To({0.2, 0.5});
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ(found->end, Nearest::End::kConverged);
  EXPECT_EQ(found->at[0], 0.1);
  EXPECT_GT(found->largest, 0.01);
  for (const Numbers& point : tried_) {
    for (size_t i = 0; i < 2; ++i) EXPECT_TRUE(space_.low[i] <= point[i] && point[i] <= space_.high[i]) << point[i];
  }
}

TEST_F(SearchOfTwo, TriesPointsOfFourDigits) {
  ASSERT_TRUE(To({0.2, 0.5}).ok());
  for (const Numbers& point : tried_) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", point[1]);
    EXPECT_EQ(point[1], std::strtod(text, nullptr));
  }
}

TEST_F(SearchOfTwo, EndsAtTheLimitOfTries) {
  limits_.tries = 3;
  const auto found = To({0.2, 0.5});
  EXPECT_EQ(found->end, Nearest::End::kTries);
  EXPECT_EQ(found->tries, 3);
  EXPECT_EQ(tried_.size(), 3u);
}

TEST(Search, FindsOneNumber) {
  const SearchSpace space{{0}, {5}, {1}, {0.2}};
  const auto found = Search(space, {1e-3, 40}, [](std::span<const double> x) -> absl::StatusOr<Numbers> {
    return Numbers{x[0] * x[0] / 2 - 1};
  });
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_NEAR(found->at[0], std::sqrt(2), 1e-3);
}

TEST(Search, GoesRoundPointsThatCannotBeMeasured) {
  const SearchSpace space{{0, 0}, {2, 2}, {1, 1}, {0.5, 0.5}};
  int unmeasurable = 0;
  const auto found = Search(space, {1e-3, 100}, [&](std::span<const double> x) -> absl::StatusOr<Numbers> {
    if (x[0] > 1.3) ++unmeasurable;
    return Numbers{x[0] > 1.3 ? NAN : x[0] - 1.2, x[1] - 0.9};
  });
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_GT(unmeasurable, 0);
  EXPECT_EQ(found->end, Nearest::End::kReached);
}

TEST(Search, ReturnsTheFirstError) {
  int calls = 0;
  const SearchSpace space{{0}, {5}, {1}, {0.2}};
  const auto found = Search(space, {}, [&](std::span<const double>) -> absl::StatusOr<Numbers> {
    if (++calls < 3) return Numbers{1};
    return absl::CancelledError("enough");
  });
  EXPECT_EQ(found.status().code(), absl::StatusCode::kCancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Search, TakesBoundsThatAreNarrowerThanItsSteps) {
  const SearchSpace space{{1}, {1.1}, {1}, {5}};
  const auto found = Search(space, {1e-3, 40},
                            [](std::span<const double> x) -> absl::StatusOr<Numbers> { return Numbers{x[0] - 1.05}; });
  ASSERT_TRUE(found.ok()) << found.status();
  EXPECT_EQ(found->end, Nearest::End::kReached);
}

}  // namespace
}  // namespace phrenic::calibrate
