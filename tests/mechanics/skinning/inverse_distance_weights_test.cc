#include "server/mechanics/skinning/inverse_distance_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace phrenic {
namespace {

Points Cloud(int n, const Eigen::Vector3d& middle, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  return Points::NullaryExpr(3, n, [&] { return uniform(random); }).colwise() + middle;
}

// Twelve clouds of vertices around a ring of 0.3 m; each has a pose.
ModelBuilder Clouds() {
  ModelBuilder builder;
  for (int c = 0; c < 12; ++c) {
    BodyModel body;
    body.pose = c;
    body.mesh.vertices = Cloud(200, {0.15 * std::cos(c * 0.52), 0.15 * std::sin(c * 0.52), 0}, 0.04, c + 1);
    builder.model.bodies.push_back(std::move(body));
  }
  return builder;
}

std::vector<int> All(const ModelBuilder& builder) {
  std::vector<int> bodies;
  for (int b = 0; b < static_cast<int>(builder.model.bodies.size()); ++b) bodies.push_back(b);
  return bodies;
}

// A path through the ring in small steps, with a leap now and then.
Points Path() {
  Points path = Cloud(2000, Eigen::Vector3d::Zero(), 0.25, 99);
  for (Eigen::Index i = 1; i < path.cols(); ++i) {
    if (i % 100 != 0) path.col(i) = path.col(i - 1) + 0.01 * path.col(i);
  }
  return path;
}

// By the definition.
std::map<int, double> WeightsOf(const ModelBuilder& builder, const Eigen::Vector3d& point) {
  std::map<int, double> weights;
  double largest = 0, kept = 0;
  for (int b = 0; b < static_cast<int>(builder.model.bodies.size()); ++b) {
    const double squared = (builder.model.bodies[b].mesh.vertices.colwise() - point).colwise().squaredNorm().minCoeff();
    weights[b] = std::pow(squared + 25e-6, -2);
    largest = std::max(largest, weights[b]);
  }
  for (auto& [body, weight] : weights) kept += weight = weight < 0.01 * largest ? 0 : weight;
  for (auto& [body, weight] : weights) weight /= kept;
  return weights;
}

class WeightsBetweenClouds : public testing::Test {
 protected:
  const ModelBuilder builder = Clouds();
  const SkinDrivers drivers{builder, All(builder)};
  InverseDistanceWeights by_distance{drivers};
  const Points path = Path();
};

TEST_F(WeightsBetweenClouds, AreByInverseDistance) {
  int shared = 0;
  for (int i = 0; i < path.cols(); ++i) {
    std::vector<SkinWeight> found;
    by_distance.Append(path.col(i), i, found);
    std::map<int, double> expected = WeightsOf(builder, path.col(i));
    for (const SkinWeight& weight : found) {
      EXPECT_NEAR(weight.weight, expected[weight.pose], 1e-9) << i;
      expected[weight.pose] = 0;
    }
    for (const auto& [body, rest] : expected) EXPECT_EQ(rest, 0) << "left out at " << i;
    shared += found.size() > 2 ? 1 : 0;
  }
  EXPECT_GT(shared, 500) << "the path is between drivers";
}

TEST_F(WeightsBetweenClouds, DoNotDependOnThePointBefore) {
  for (int i = 0; i < path.cols(); ++i) {
    std::vector<SkinWeight> found, alone;
    by_distance.Append(path.col(i), i, found);
    InverseDistanceWeights(drivers).Append(path.col(i), i, alone);
    ASSERT_EQ(found.size(), alone.size()) << i;
    for (size_t s = 0; s < found.size(); ++s) {
      EXPECT_EQ(found[s].pose, alone[s].pose) << i;
      EXPECT_EQ(found[s].weight, alone[s].weight) << i;
    }
  }
}

}  // namespace
}  // namespace phrenic
