// What carriers do to a riding body's vertices, against the definition of a share (skin.h), one by one.
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/skinning/skin_kernel.h"
#include "tests/mechanics/every_target.h"

namespace phrenic {
namespace {

constexpr int kSimulated = 20, kPoses = 5, kVertices = 50;

struct Riding {
  Points rest_of_carriers, x, v, rest;
  std::vector<Pose> poses;
  std::vector<PoseMatrices> columns;
  std::vector<SkinWeight> shares;
};

struct Moved {
  Points x, v;
};

// Up to four shares a vertex; every seventh has none.
Riding RandomRiding() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  const auto points = [&](int n) { return Points(Points::NullaryExpr(3, n, [&] { return value(random); })); };
  const auto vector = [&] { return Eigen::Vector3d(value(random), value(random), value(random)); };
  Riding made{points(kSimulated), points(kSimulated), points(kSimulated), points(kVertices), {}, {}, {}};
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(value(random), vector().normalized()));
    made.poses.push_back({turn, vector(), vector(), vector()});
    made.columns.emplace_back(made.poses.back());
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

Moved ByDefinition(const Riding& of) {
  Moved out{of.rest, Points::Zero(3, kVertices)};
  for (const SkinWeight& share : of.weights) {
    const Eigen::Vector3d rest = of.rest.col(share.vertex);
    if (share.pose >= 0) {
      out.x.col(share.vertex) += share.weight * (of.poses[share.pose].At(rest) - rest);
      out.v.col(share.vertex) += share.weight * of.poses[share.pose].VelocityAt(rest);
    } else {
      const int carrier = share.simulated_vertex;
      out.x.col(share.vertex) += share.weight * (of.x.col(carrier) - of.rest_of_carriers.col(carrier));
      out.v.col(share.vertex) += share.weight * of.v.col(carrier);
    }
  }
  return out;
}

Moved Ours(const Riding& of, bool velocities) {
  Moved out{of.rest, Points::Zero(3, kVertices)};
  const DriverState carriers = {of.columns, of.rest_of_carriers.data(), of.x.data(), of.v.data()};
  ApplySkinWeights(of.weights, carriers, of.rest.data(), out.x.data(), velocities ? out.v.data() : nullptr);
  return out;
}

TEST(ApplySkinWeights, MovesEachVertexByItsSharesWithTheSameBitsOnEveryInstructionSet) {
  const Riding riding = RandomRiding();
  const Moved exact = ByDefinition(riding), here = Ours(riding, true);
  EXPECT_LT((here.x - exact.x).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((here.v - exact.v).cwiseAbs().maxCoeff(), 1e-14);
  OnEveryTarget([&] {
    EXPECT_EQ(Ours(riding, true).x, here.x);
    EXPECT_EQ(Ours(riding, true).v, here.v);
  });
}

TEST(ApplySkinWeights, PutsPositionsAloneWhereTheyAreWithVelocities) {
  const Riding riding = RandomRiding();
  const Moved both = Ours(riding, true);
  OnEveryTarget([&] {
    EXPECT_EQ(Ours(riding, false).x, both.x);
    EXPECT_TRUE(Ours(riding, false).v.isZero(0));
  });
}

}  // namespace
}  // namespace phrenic
