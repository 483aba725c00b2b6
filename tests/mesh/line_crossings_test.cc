#include "server/mesh/line_crossings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

TEST(LineCrossings, AreTheEndsOfTheChordsOfABall) {
  const Mesh ball = EllipsoidSurface({10, 10, 3}, {8, 8, 8}, 60, false);
  const auto crossings = LineCrossings(ball.vertices, ball.triangles, {21, 25});
  ASSERT_EQ(crossings.size(), 21U * 25);
  for (int j = 0; j < 25; ++j) {
    for (int i = 0; i < 21; ++i) {
      const auto& along = crossings[static_cast<size_t>(j) * 21 + i];
      const double from_axis = std::hypot(i - 10, j - 10);
      if (std::abs(from_axis - 8) < 0.1) continue;
      ASSERT_EQ(along.size(), from_axis < 8 ? 2U : 0U) << i << " " << j;
      if (along.empty()) continue;
      EXPECT_NEAR(along[1] - along[0], 2 * std::sqrt(64 - from_axis * from_axis), 0.05);
      EXPECT_NEAR(along[0] + along[1], 6, 1e-3);
    }
  }
}

TEST(LineCrossings, OutsideTheGridAreLeftOut) {
  const Mesh ball = EllipsoidSurface({0, 0, 0}, {8, 8, 8}, 8, false);
  EXPECT_EQ(LineCrossings(ball.vertices, ball.triangles, {1, 1}).front().size(), 2U);
}

}  // namespace
}  // namespace phrenic
