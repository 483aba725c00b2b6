// Checks nearest-point search against dense sampling and against closed forms.
#include "server/mesh/triangle_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/mesh/solids.h"

namespace phrenic {
namespace {

double Uniform(std::mt19937& random) { return std::uniform_real_distribution<double>(-1, 1)(random); }

// Returns the distance to the nearest of dense samples of the triangles: a close upper bound.
double SampledDistance(const Points& x, const Triangles& triangles, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  constexpr int kSteps = 40;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
        const Eigen::Vector3d point =
            (1 - u - v) * x.col(triangles(0, t)) + u * x.col(triangles(1, t)) + v * x.col(triangles(2, t));
        nearest = std::min(nearest, (point - p).norm());
      }
    }
  }
  return nearest;
}

TEST(TriangleTree, FindsTheNearestPointAlsoOnAMovedSurface) {
  std::mt19937 random(4);
  Points x(3, 40);
  for (double& value : x.reshaped()) value = Uniform(random);
  Triangles triangles(3, 30);
  for (int t = 0; t < 30; ++t) triangles.col(t) = Eigen::Vector3i(t, t + 3, t + 10);
  const TriangleTree tree(x, triangles);
  for (int move = 0; move < 2; ++move) {
    TriangleTree::Boxes boxes;
    tree.Fit(x, boxes);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d point = 2 * Eigen::Vector3d(Uniform(random), Uniform(random), Uniform(random));
      const SurfacePoint found = tree.Nearest(x, boxes, point, 100);
      const Eigen::Vector3i corners = tree.triangle(found.triangle);
      Eigen::Vector3d there = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) there += found.weights[k] * x.col(corners[k]);
      EXPECT_GE(found.weights.minCoeff(), 0);
      EXPECT_NEAR(found.weights.sum(), 1, 1e-12);
      EXPECT_LT((there - point - found.offset).norm(), 1e-12);
      const double sampled = SampledDistance(x, triangles, point);
      EXPECT_LE(found.offset.norm(), sampled + 1e-12);
      EXPECT_GT(found.offset.norm(), sampled - 0.05);
      EXPECT_EQ(tree.Nearest(x, boxes, point, 0.9 * found.offset.norm()).triangle, -1) << "out of reach";
    }
    for (double& value : x.reshaped()) value += 0.5 * Uniform(random);
  }
}

// Includes nearest points on edges and vertices; a torus has convex and concave ones.
TEST(TriangleTree, FacingTellsInsideFromOutsideOfAClosedSurface) {
  const Mesh torus = Torus(1, 0.4, 24, 12);
  const TriangleTree tree(torus.vertices, torus.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(torus.vertices, boxes);
  std::mt19937 random(8);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point(1.5 * Uniform(random), 1.5 * Uniform(random), 0.5 * Uniform(random));
    const double tube = std::hypot(point.head<2>().norm() - 1, point.z());
    if (std::abs(tube - 0.4) < 0.03) continue;  // between the torus and its facets
    const SurfacePoint found = tree.Nearest(torus.vertices, boxes, point, 10);
    EXPECT_EQ(found.facing > 0, tube < 0.4) << point.transpose();
    EXPECT_FALSE(found.on_boundary);
  }
}

TEST(TriangleTree, MarksPointsOnTheBoundaryOfAnOpenSurface) {
  const Mesh solid = Tetrahedron();
  const TriangleTree tree(solid.vertices, solid.triangles.leftCols(1));  // the face at z = 0
  TriangleTree::Boxes boxes;
  tree.Fit(solid.vertices, boxes);
  EXPECT_FALSE(tree.Nearest(solid.vertices, boxes, {0.2, 0.2, 1}, 10).on_boundary);
  EXPECT_TRUE(tree.Nearest(solid.vertices, boxes, {0.2, -0.1, 1}, 10).on_boundary);
  EXPECT_TRUE(tree.Nearest(solid.vertices, boxes, {-0.2, -0.1, 1}, 10).on_boundary);
}

}  // namespace
}  // namespace phrenic
