// A walk over a surface against the search of all of it.
#include "server/mesh/surface_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

// A sphere of 100 mm radius that is dented by 4 mm.
Points Dented(const Points& sphere) {
  Points x = sphere;
  for (auto point : x.colwise()) point *= 1 + 0.04 * std::sin(30 * point.x()) * std::cos(25 * point.y());
  return x;
}

TEST(SurfaceWalk, EndsAtTheNearestPointOfAMovedSurface) {
  const Mesh sphere = EllipsoidSurface({0, 0, 0}, {0.1, 0.1, 0.1}, 16, false);
  const TriangleTree tree(sphere.vertices, sphere.triangles);
  const SurfaceWalk walk(tree);
  const Points x = Dented(sphere.vertices);
  TriangleTree::Boxes boxes;
  tree.Fit(x, boxes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d way = Eigen::Vector3d(value(random), value(random), value(random)).normalized();
    const Eigen::Vector3d point = (0.1 + 0.02 * value(random)) * way;
    const SurfacePoint nearest = tree.Nearest(x, boxes, point, 1);
    const auto start = static_cast<int>(random() % static_cast<unsigned>(sphere.triangles.cols()));
    const Eigen::Vector3d centre = x(Eigen::all, tree.triangle(start)).rowwise().mean();
    if ((centre - point).norm() > 0.05) continue;  // the walk is for starts that are near
    const SurfacePoint found = walk.Nearest(x, point, start);
    EXPECT_NEAR(std::sqrt(found.squared), std::sqrt(nearest.squared), 1e-9);
    EXPECT_EQ(found.facing > 0, nearest.facing > 0);
  }
}

// Of two patches that share no vertex a walk finds only that on which it starts.
TEST(SurfaceWalk, StaysOnItsPatch) {
  Points x(3, 6);
  x.setZero();
  x.col(1).x() = x.col(2).y() = 0.1;
  x.rightCols(3) = x.leftCols(3).colwise() + Eigen::Vector3d(0, 0, 0.1);
  const Triangles triangles = (Triangles(3, 2) << 0, 3, 1, 4, 2, 5).finished();
  const TriangleTree tree(x, triangles);
  const SurfaceWalk walk(tree);
  const int lower = tree.triangle(0)[0] < 3 ? 0 : 1;
  const SurfacePoint found = walk.Nearest(x, {0.01, 0.01, 0.09}, lower);
  EXPECT_EQ(found.triangle, lower);
  EXPECT_NEAR(found.squared, 0.09 * 0.09, 1e-12);
}

}  // namespace
}  // namespace phrenic
