// Skinned vertices against the definition of a skin weight (skin.h), one by one.
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/skinning/skin_kernel.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

constexpr int kSimulated = 20, kPoses = 5, kVertices = 50;

struct Skinned {
  Points rest_of_drivers, x, v, rest;
  std::vector<Pose> poses;
  std::vector<PoseMatrices> matrices;
  std::vector<SkinWeight> weights;
};

struct Moved {
  Points x, v;
};

// Up to four weights per vertex; every seventh has none.
Skinned RandomSkin() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  const auto points = [&](int n) { return Points(Points::NullaryExpr(3, n, [&] { return value(random); })); };
  const auto vector = [&] { return Eigen::Vector3d(value(random), value(random), value(random)); };
  Skinned made{points(kSimulated), points(kSimulated), points(kSimulated), points(kVertices), {}, {}, {}};
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(value(random), vector().normalized()));
    made.poses.push_back({turn, vector(), vector(), vector()});
    made.matrices.emplace_back(made.poses.back());
  }
  for (int vertex = 0; vertex < kVertices; ++vertex) {
    for (int s = 0; s < (vertex % 7 == 0 ? 0 : 1 + vertex % 4); ++s) {
      const bool of_pose = value(random) > 0;
      made.weights.push_back({vertex, of_pose ? static_cast<int>(random() % kPoses) : -1,
                              of_pose ? -1 : static_cast<int>(random() % kSimulated), value(random)});
    }
  }
  return made;
}

Moved ByDefinition(const Skinned& of) {
  Moved out{of.rest, Points::Zero(3, kVertices)};
  for (const SkinWeight& weight : of.weights) {
    const Eigen::Vector3d rest = of.rest.col(weight.vertex);
    if (weight.pose >= 0) {
      out.x.col(weight.vertex) += weight.weight * (of.poses[weight.pose].At(rest) - rest);
      out.v.col(weight.vertex) += weight.weight * of.poses[weight.pose].VelocityAt(rest);
    } else {
      const int driver = weight.simulated_vertex;
      out.x.col(weight.vertex) += weight.weight * (of.x.col(driver) - of.rest_of_drivers.col(driver));
      out.v.col(weight.vertex) += weight.weight * of.v.col(driver);
    }
  }
  return out;
}

Moved Ours(const Skinned& of, bool velocities) {
  Moved out{of.rest, Points::Zero(3, kVertices)};
  std::vector<Displacement> displacements;
  SetDisplacements(of.x, of.rest_of_drivers.data(), displacements);
  const DriverState drivers = {of.matrices, displacements.data(), of.v.data()};
  ApplySkinWeights(SkinWeights(of.weights), drivers, of.rest.data(), out.x.data(), velocities ? out.v.data() : nullptr);
  return out;
}

TEST(ApplySkinWeights, MovesEachVertexByItsWeightsWithTheSameBitsOnEveryInstructionSet) {
  const Skinned skinned = RandomSkin();
  const Moved exact = ByDefinition(skinned), here = Ours(skinned, true);
  EXPECT_LT((here.x - exact.x).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((here.v - exact.v).cwiseAbs().maxCoeff(), 1e-14);
  OnEveryTarget([&] {
    EXPECT_EQ(Ours(skinned, true).x, here.x);
    EXPECT_EQ(Ours(skinned, true).v, here.v);
  });
}

TEST(ApplySkinWeights, GivesTheSamePositionsWithoutVelocities) {
  const Skinned skinned = RandomSkin();
  const Moved both = Ours(skinned, true);
  OnEveryTarget([&] {
    EXPECT_EQ(Ours(skinned, false).x, both.x);
    EXPECT_TRUE(Ours(skinned, false).v.isZero(0));
  });
}

}  // namespace
}  // namespace phrenic
