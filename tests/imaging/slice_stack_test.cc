// Slices in any order make a grid whose distance is that of neighbours, or an error.
#include "server/imaging/slice_stack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace phrenic::imaging {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

absl::StatusOr<SliceStack> StackAt(const std::vector<double>& heights, double stated = 0) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(heights.size());
  for (const double height : heights) positions.emplace_back(1, 2, height);
  return StackSlices({}, positions, stated);
}

TEST(SliceStack, SlicesAreNumberedAlongTheNormal) {
  const auto stack = StackAt({30, 10, 20, 10});
  ASSERT_TRUE(stack.ok()) << stack.status();
  EXPECT_EQ(stack->slices, 3);
  EXPECT_THAT(stack->slice_of, ElementsAre(2, 0, 1, 0));
  EXPECT_LT((stack->to_patient * Eigen::Vector3d(1, 1, 2) - Eigen::Vector3d(2, 3, 30)).norm(), 1e-12);
}

// No empty slice comes between neighbours, whatever is stated: it would cut every organ into slices.
TEST(SliceStack, NeighboursTakePrecedenceOverTheStatedDistance) {
  for (const double stated : {0.0, 1.5, 3.0, 7.0}) {
    const auto stack = StackAt({0, 3, 6, 12}, stated);
    ASSERT_TRUE(stack.ok()) << stack.status();
    EXPECT_THAT(stack->slice_of, ElementsAre(0, 1, 2, 4));
  }
}

TEST(SliceStack, WithoutNeighboursTheStatedDistanceCounts) {
  const auto stack = StackAt({0, 2, 5}, 1);
  ASSERT_TRUE(stack.ok()) << stack.status();
  EXPECT_THAT(stack->slice_of, ElementsAre(0, 2, 5));
  EXPECT_EQ(StackAt({4}, 2)->slices, 1);
  EXPECT_THAT(std::string(StackAt({0, 2, 5}).status().message()), HasSubstr("not equidistant"));
  EXPECT_THAT(std::string(StackAt({4}).status().message()), HasSubstr("thickness"));
}

// Archives round positions to hundredths of a millimetre.
TEST(SliceStack, RoundedPositionsAreAGrid) {
  std::vector<double> heights;
  for (int k = 0; k < 600; ++k) {
    if (k % 97 < 60) heights.push_back(std::round(62.5 * k) / 100);
  }
  const auto stack = StackAt(heights);
  ASSERT_TRUE(stack.ok()) << stack.status();
  EXPECT_EQ(stack->slice_of.back(), std::lround(heights.back() / 0.625));
  EXPECT_NEAR(stack->to_patient.linear().col(2).norm(), 0.625, 1e-4);
}

TEST(SliceStack, ShiftedSlicesAreRefused) {
  const auto stack = StackSlices({}, {{0, 0, 0}, {0.5, 0, 1}, {0, 0, 2}}, 1);
  EXPECT_THAT(std::string(stack.status().message()), HasSubstr("frame 2 is 0.5 mm beside"));
}

}  // namespace
}  // namespace phrenic::imaging
