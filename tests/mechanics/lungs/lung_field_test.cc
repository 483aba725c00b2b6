#include "server/mechanics/lungs/lung_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

// A lung of which every point x moves by A (x - centre).
LungMotion Stretched(double x, const Eigen::Matrix3d& a) {
  const Eigen::Vector3d centre(x, 0, 0.2);
  absl::StatusOr<LungTissue> tissue =
      LungTissue::Make(EllipsoidSurface(centre, {0.04, 0.06, 0.1}, 12, false), {.edge = 0.03});
  if (!tissue.ok()) throw std::runtime_error(std::string(tissue.status().message()));
  const Points nodes = a * (tissue->grid().nodes().colwise() - centre);
  return {*std::move(tissue), nodes};
}

TEST(LungField, HoldsEachLungWhereItIs) {
  Eigen::Matrix3d a;
  a << 0.1, 0.02, 0, 0, 0.05, 0, -0.3, 0, -0.02;
  const std::vector<LungMotion> lungs = {Stretched(-0.07, a), Stretched(0.07, 2 * a)};
  const auto field = SampleLungs(lungs, 0.0093);  // no point is on a surface
  ASSERT_TRUE(field.ok()) << field.status();
  ASSERT_EQ(field->size.prod(), field->ventilation.size());
  double volume = 0;
  for (Eigen::Index i = 0; i < field->ventilation.size(); ++i) {
    const int lung = field->lung[i];
    const Eigen::Vector3d point = field->PointAt(i);
    if (lung == 0) {
      EXPECT_TRUE(field->displacement.col(i).isZero());
      EXPECT_FALSE(lungs[point.x() > 0].tissue.Contains(point)) << point.transpose();
      continue;
    }
    volume += 0.0093 * 0.0093 * 0.0093;
    ASSERT_EQ(lung, point.x() > 0 ? 2 : 1);
    const Eigen::Vector3d centre(point.x() > 0 ? 0.07 : -0.07, 0, 0.2);
    EXPECT_LT((field->displacement.col(i) - lung * a * (point - centre)).norm(), 1e-12);
    EXPECT_NEAR(field->ventilation[i], 0.13 * lung, 1e-9);
  }
  EXPECT_NEAR(volume, 2 * 4.18879 * 0.04 * 0.06 * 0.1, 0.05 * volume);
}

TEST(LungField, IsNeitherEmptyNorEndless) {
  EXPECT_FALSE(SampleLungs({}, 0.01).ok());
  const LungMotion lung = Stretched(0.07, Eigen::Matrix3d::Zero());
  EXPECT_THAT(SampleLungs(std::span(&lung, 1), 1e-5).status().message(), testing::HasSubstr("spacing larger"));
}

}  // namespace
}  // namespace phrenic
