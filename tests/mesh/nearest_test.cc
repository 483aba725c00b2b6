#include "server/mesh/nearest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace phrenic {
namespace {

Points RandomPoints(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Points::NullaryExpr(3, n, [&] { return uniform(random); });
}

// Returns an 11 x 11 x 11 lattice, in which many distances are exactly equal.
Points Grid() {
  Points points(3, 11 * 11 * 11);
  for (int i = 0; i < points.cols(); ++i) points.col(i) << i % 11, i / 11 % 11, i / 121;
  return points;
}

Neighbour BruteForce(const Points& points, const Eigen::Vector3d& query) {
  Neighbour best{-1, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < points.cols(); ++i) {
    const double distance = (points.col(i) - query).norm();
    if (distance < best.distance) best = {i, distance};
  }
  return best;
}

TEST(Nearest, EqualsBruteForce) {
  const Points points = RandomPoints(2000, 1), queries = RandomPoints(500, 2);
  const NearestSearch search(points);
  for (Eigen::Index q = 0; q < queries.cols(); ++q) {
    const Neighbour expected = BruteForce(points, 2 * queries.col(q));
    const Neighbour found = search.Nearest(2 * queries.col(q));
    EXPECT_EQ(found.vertex, expected.vertex);
    EXPECT_NEAR(found.distance, expected.distance, 1e-15);
  }
}

TEST(Nearest, TiesGoToTheLowestIndex) {
  const Points points = Grid();
  const NearestSearch search(points);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d centre = points.col(i * 133).array() + 0.5;  // equally far from the cell's eight corners
    EXPECT_EQ(search.Nearest(centre).vertex, i * 133);
  }
}

TEST(Nearest, TiesAmongCoincidentPointsGoToTheFirst) {
  Points points = Points::Constant(3, 300, 0.25);
  points.col(0).setConstant(9);
  const Neighbour found = NearestSearch(points).Nearest(Eigen::Vector3d::Constant(0.25));
  EXPECT_EQ(found.vertex, 1);
  EXPECT_EQ(found.distance, 0);
}

TEST(Nearest, ASinglePointIsAlwaysTheNearest) {
  const NearestSearch search(Points::Constant(3, 1, 1.0));
  EXPECT_EQ(search.Nearest({1e6, 0, 0}).vertex, 0);
}

TEST(Nearest, ReachOnlyLimitsTheDistance) {
  const Points points = RandomPoints(2000, 1), queries = RandomPoints(500, 2);
  const NearestSearch search(points);
  for (Eigen::Index q = 0; q < queries.cols(); ++q) {
    const Neighbour nearest = search.Nearest(queries.col(q));
    for (const double reach : {nearest.distance, 1.5 * nearest.distance}) {
      EXPECT_EQ(search.Nearest(queries.col(q), reach).vertex, nearest.vertex);
      EXPECT_EQ(search.Nearest(queries.col(q), reach).distance, nearest.distance);
    }
    const Neighbour none = search.Nearest(queries.col(q), std::nextafter(nearest.distance, 0));
    EXPECT_EQ(none.vertex, -1);
    EXPECT_EQ(none.distance, std::numeric_limits<double>::infinity());
  }
}

TEST(Within, IncludesTheBoundaryNearestFirst) {
  const std::vector<Neighbour> found = NearestSearch(Grid()).Within({5, 5, 5}, 1);
  ASSERT_EQ(found.size(), 7U);  // the centre and six at exactly 1 m
  EXPECT_EQ(found[0].vertex, 5 * 133);
  for (size_t i = 1; i < found.size(); ++i) EXPECT_EQ(found[i].distance, 1);
  for (size_t i = 2; i < found.size(); ++i) EXPECT_LT(found[i - 1].vertex, found[i].vertex);
}

TEST(Within, EqualsBruteForce) {
  const Points points = RandomPoints(2000, 3);
  const NearestSearch search(points);
  for (const double radius : {0.0, 0.05, 0.3, 4.0}) {
    const Eigen::Vector3d query(0.1, -0.2, 0.3);
    const long expected = ((points.colwise() - query).colwise().norm().array() <= radius).count();
    EXPECT_EQ(static_cast<long>(search.Within(query, radius).size()), expected) << radius;
  }
}

TEST(Within, IsEmptyForANegativeOrNanRadius) {
  EXPECT_TRUE(NearestSearch(Grid()).Within({5, 5, 5}, -2).empty());
  EXPECT_TRUE(NearestSearch(Grid()).Within({5, 5, 5}, std::numeric_limits<double>::quiet_NaN()).empty());
}

}  // namespace
}  // namespace phrenic
