// The weight of a lung: its modulus by the recoil curve, and what that does to its tissue.
#include "server/mechanics/lungs/lung_weight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/mechanics/lungs/lung_tissue.h"
#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

constexpr double kRecoilRate = 6.5e-4, kRoom = 3.6e-3, kVolume = 3e-3;

LungWeight Upright() {
  v1::LungPair lungs;
  lungs.set_recoil_rate(kRecoilRate);
  lungs.set_room(kRoom);
  return WeightOfLungs(lungs, kVolume, {0, 0, 0.2}, -Eigen::Vector3d::UnitZ());
}

TEST(LungWeight, IsTheBulkModulusOfTheRecoilCurve) {
  const auto volume = [](double recoil) { return kVolume + kRoom * (1 - std::exp(-kRecoilRate * recoil)); };
  const auto bulk = [&](double recoil) {
    constexpr double kStep = 0.1;  // [Pa]
    return volume(recoil) * 2 * kStep / (volume(recoil + kStep) - volume(recoil - kStep));
  };
  for (const double height : {-0.1, 0.0, 0.03, 0.12}) {
    const double recoil = kLungDensity * 9.81 * height;
    EXPECT_NEAR(Upright().ModulusAt({0.05, -0.02, 0.2 + height}), bulk(recoil) / bulk(0), 1e-6) << height;
  }
}

TEST(LungWeight, IsPositiveHoweverFarBelow) {
  EXPECT_GT(Upright().ModulusAt({0, 0, -10}), 0);
  EXPECT_LT(Upright().ModulusAt({0, 0, -10}), 0.1);
}

TEST(LungWeight, OfNothingChangesNoBit) {
  const Mesh shape = EllipsoidSurface({0.07, 0.01, 0.2}, {0.05, 0.08, 0.12}, 24, false);
  const LungTissue tissue = *LungTissue::Make(shape, {.edge = 0.02});
  const Eigen::VectorXd g = 0.01 * tissue.normals().row(2).transpose().cwiseMin(0.2);
  EXPECT_EQ(tissue.Under(LungWeight()).Solve(g), tissue.Solve(g));
}

// A lung that widens evenly gains more below than above, and without weight the same.
TEST(LungWeight, LetsTheLowerPartGainMore) {
  const Mesh shape = EllipsoidSurface({0.07, 0.01, 0.2}, {0.05, 0.08, 0.12}, 24, false);
  const LungTissue tissue = *LungTissue::Make(shape, {.edge = 0.02});
  const auto below_over_above = [&](const LungWeight& weight) {
    const LungTissue under = tissue.Under(weight);
    const Points nodes = under.Solve(Eigen::VectorXd::Constant(tissue.points().cols(), 0.003));
    const auto gain = [&](double z) { return under.GradientAt(nodes, {0.07, 0.01, z}).trace(); };
    return gain(0.14) / gain(0.26);
  };
  EXPECT_NEAR(below_over_above(LungWeight()), 1, 0.02);
  EXPECT_GT(below_over_above(Upright()), 1.15);
}

TEST(LungWeight, IsRefusedOutOfRange) {
  const Mesh shape = EllipsoidSurface({0.07, 0.01, 0.2}, {0.05, 0.08, 0.12}, 12, false);
  LungElasticity heavy = {.edge = 0.03};
  heavy.weight.rise = {0, 0, 1000};
  EXPECT_FALSE(LungTissue::Make(shape, heavy).ok());
  heavy.weight = {};
  heavy.weight.room = -1;
  EXPECT_FALSE(LungTissue::Make(shape, heavy).ok());
}

}  // namespace
}  // namespace phrenic
