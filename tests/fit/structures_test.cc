// A person's lungs as surfaces: registered, compared, and refused where the sides cannot be right.
#include "server/fit/structures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fit/template_lungs.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

// The template itself, scaled along each axis and shifted.
std::vector<PersonStructure> ScaledLungs(const Eigen::Vector3d& scale, const Eigen::Vector3d& shift) {
  std::vector<PersonStructure> structures;
  for (const Side side : {kRight, kLeft}) {
    Mesh lung = GeneratedLungs()[side].surface();
    lung.vertices = (scale.asDiagonal() * lung.vertices).colwise() + shift;
    structures.push_back({side == kLeft ? "lung-left" : "lung-right", side == kLeft ? "l.stl" : "r.stl", lung});
  }
  return structures;
}

TEST(Structures, OfAScaledTemplateGiveItsScale) {
  const Eigen::Vector3d scale(1.1, 0.95, 1.2);
  const auto structures = ScaledLungs(scale, {0.02, -0.01, 0.3});
  const auto points = PointsInLungs(structures);
  ASSERT_TRUE(points.ok()) << points.status();
  EXPECT_GT(points->cols(), 2000);
  const auto registered = RegisterLungs(GeneratedLungs(), *points);
  ASSERT_TRUE(registered.ok()) << registered.status();
  for (const Side side : {kRight, kLeft}) {
    EXPECT_LT((registered->lungs[side].scale.cwiseQuotient(scale) - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff(),
              0.06);
  }
  const auto residuals = CompareStructures(GeneratedLungs(), *registered, structures);
  ASSERT_EQ(residuals.size(), 2u);
  for (const StructureResidual& each : residuals) {
    std::printf("%s: %.2f mm, p95 %.2f\n", each.name.c_str(), 1e3 * each.mean, 1e3 * each.p95);
    EXPECT_TRUE(each.shaped);
    EXPECT_LT(each.mean, 0.003);
  }
}

TEST(Structures, OfADiaphragmJudgeTheBasesAlone) {
  auto structures = ScaledLungs({1, 1, 1}, {0, 0, 0});
  RegisteredLungs same;
  Mesh below = GeneratedLungs()[kRight].surface();
  below.vertices.row(2).array() -= 0.005;
  structures.push_back({"diaphragm", "d.stl", below});
  const auto residuals = CompareStructures(GeneratedLungs(), same, structures);
  ASSERT_EQ(residuals.size(), 3u);
  EXPECT_LT(residuals[0].mean, 1e-9);
  EXPECT_FALSE(residuals[2].shaped);
  EXPECT_GT(residuals[2].mean, 0.003);
}

TEST(Structures, ThatCannotBeRightAreRefused) {
  const auto fault = [](const std::vector<PersonStructure>& structures) {
    return std::string(PointsInLungs(structures).status().message());
  };
  auto lungs = ScaledLungs({1, 1, 1}, {0, 0, 0});
  auto swapped = lungs;
  std::swap(swapped[0].name, swapped[1].name);
  EXPECT_THAT(fault(swapped), HasSubstr("in LPS the left has the larger x"));
  auto mirrored = ScaledLungs({-1, 1, 1}, {0, 0, 0});
  EXPECT_THAT(fault(mirrored), HasSubstr("faces inwards"));
  auto open = lungs;
  open[1].surface.triangles.conservativeResize(3, open[1].surface.triangles.cols() - 3);
  EXPECT_THAT(fault(open), HasSubstr("l.stl: the surface of lung-left is not closed"));
  lungs.pop_back();
  EXPECT_THAT(fault(lungs), HasSubstr("the left lung is missing"));
  // Turned about x, the gap is right, and the rest is refused by the axes' check.
  auto turned = ScaledLungs({1, -1, -1}, {0, 0, 0});
  const auto points = PointsInLungs(turned);
  ASSERT_TRUE(points.ok()) << points.status();
  EXPECT_THAT(std::string(RegisterLungs(GeneratedLungs(), *points).status().message()), HasSubstr("reverse the sign"));
}

}  // namespace
}  // namespace phrenic::fit
