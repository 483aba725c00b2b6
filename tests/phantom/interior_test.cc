// How the inside of a ball moves when its surface moves in ways whose inside is known.
#include "server/phantom/interior.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "server/mesh/topology.h"

namespace phrenic::phantom {
namespace {

// Returns a ball by latitudes and longitudes, facing outwards [m].
Mesh Ball(double radius) {
  constexpr int kRows = 24, kColumns = 36;
  std::vector<Eigen::Vector3d> vertices = {{0, 0, radius}};
  for (int row = 1; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double theta = M_PI * row / kRows, phi = 2 * M_PI * column / kColumns;
      vertices.emplace_back(radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                            radius * std::cos(theta));
    }
  }
  vertices.emplace_back(0, 0, -radius);
  const int last = static_cast<int>(vertices.size()) - 1;
  const auto at = [&](int row, int column) {
    return row == 0 ? 0 : row == kRows ? last : 1 + (row - 1) * kColumns + column % kColumns;
  };
  std::vector<Eigen::Vector3i> triangles;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      if (row > 0) triangles.emplace_back(at(row, column), at(row + 1, column), at(row, column + 1));
      if (row < kRows - 1) triangles.emplace_back(at(row, column + 1), at(row + 1, column), at(row + 1, column + 1));
    }
  }
  Mesh ball;
  ball.vertices.resize(3, last + 1);
  for (int v = 0; v <= last; ++v) ball.vertices.col(v) = vertices[static_cast<std::size_t>(v)];
  ball.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) ball.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return ball;
}

const Eigen::Vector3d kPlaces[] = {{0, 0, 0}, {0.02, 0.01, -0.03}, {-0.03, 0.02, 0.01}, {0, 0.04, 0}};

TEST(Interior, OfARigidMotionMovesRigidly) {
  const Mesh ball = Ball(0.06);
  ASSERT_GT(SignedVolume(ball.vertices, ball.triangles), 0);
  Interior interior(ball, false);
  Eigen::Isometry3d motion(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  motion.translation() = Eigen::Vector3d(0.01, -0.02, 0.03);
  interior.MoveTo(motion * ball.vertices);
  EXPECT_FALSE(interior.is_elastic());
  for (const Eigen::Vector3d& place : kPlaces) {
    EXPECT_LT((place + interior.DisplacementAt(place) - motion * place).norm(), 1e-9);
    EXPECT_LT((interior.OriginOf(motion * place) - place).norm(), 1e-9);
    EXPECT_EQ(interior.VolumeRatioAt(place), 1);
  }
}

TEST(Interior, OfABallThatGrowsGrowsEvenly) {
  const Mesh ball = Ball(0.06);
  for (const bool slides : {true, false}) {
    Interior interior(ball, slides);
    interior.MoveTo(1.2 * ball.vertices);
    ASSERT_TRUE(interior.is_elastic());
    EXPECT_LT(interior.misfit(), 5e-4);
    for (const Eigen::Vector3d& place : kPlaces) {
      EXPECT_LT((interior.DisplacementAt(place) - 0.2 * place).norm(), 4e-4) << "slides " << slides;
      EXPECT_NEAR(interior.VolumeRatioAt(place), 1.728, 0.06) << "slides " << slides;
    }
  }
}

TEST(Interior, FetchesThePointThatIsMovedToAPlace) {
  const Mesh ball = Ball(0.06);
  Points moved = ball.vertices;
  moved.row(2) = 1.3 * moved.row(2).array() + 2 * moved.row(0).array().square();
  for (const bool slides : {true, false}) {
    Interior interior(ball, slides);
    interior.MoveTo(moved);
    for (const Eigen::Vector3d& place : kPlaces) {
      const Eigen::Vector3d now = place + interior.DisplacementAt(place);
      EXPECT_LT((interior.OriginOf(now) - place).norm(), 1e-5);
    }
  }
}

TEST(Interior, OfWhatIsThinMovesWithTheNearestSurface) {
  Mesh plate = Ball(0.06);
  plate.vertices.row(2) *= 0.03;
  Interior interior(plate, false);
  Points moved = plate.vertices;
  moved.row(2).array() += plate.vertices.row(0).array() / 2;
  interior.MoveTo(moved);
  EXPECT_FALSE(interior.is_elastic());
  const Eigen::Vector3d place(0.02, 0.01, 0.0005);
  EXPECT_NEAR(interior.DisplacementAt(place).z(), 0.01, 1e-4);
  EXPECT_LT((interior.OriginOf(place + interior.DisplacementAt(place)) - place).norm(), 1e-5);
}

// A surface that faces inwards encloses a compact place in which no tissue can be made: it is no thin one.
TEST(Interior, SaysWhyACompactSurfaceHasNoTissue) {
  Mesh ball = Ball(0.06), plate = Ball(0.06);
  plate.vertices.row(2) *= 0.03;
  EXPECT_TRUE(Interior(ball, true).tissue().ok());
  EXPECT_TRUE(Interior(plate, true).tissue().ok());
  ball.triangles.row(0).swap(ball.triangles.row(1));
  Interior interior(ball, true);
  EXPECT_THAT(std::string(interior.tissue().message()), testing::HasSubstr("must face outwards"));
  interior.MoveTo(1.2 * ball.vertices);
  EXPECT_FALSE(interior.is_elastic());
}

}  // namespace
}  // namespace phrenic::phantom
