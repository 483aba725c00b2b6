// Whose side a point is on, which axes cannot be, and lungs moved onto points.
#include "server/fit/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/fit/person.h"
#include "tests/fit/synthetic_person.h"

namespace phrenic::fit {
namespace {

using testing::HasSubstr;

std::string SidesFault(const Points& points) { return std::string(FindSides(points).status().message()); }

// Returns the person's points with each axis taken from another, with a sign.
Points WithAxes(const std::array<int, 3>& from, const Eigen::Vector3d& signs) {
  const Points points = SyntheticPerson().exhale;
  return signs.asDiagonal() * points(from, Eigen::all);
}

TEST(Sides, AreThoseThatThePointsWereMadeFor) {
  const Landmarks person = SyntheticPerson();
  const auto sides = FindSides(person.exhale);
  ASSERT_TRUE(sides.ok()) << sides.status();
  for (size_t i = 0; i < sides->of.size(); ++i) ASSERT_EQ(sides->of[i], i < sides->of.size() / 2 ? kRight : kLeft) << i;
}

TEST(Sides, AreRefusedIfTheAxesCannotBeRight) {
  EXPECT_EQ(SidesFault(WithAxes({0, 1, 2}, {1, 1, 1})), "");
  EXPECT_THAT(SidesFault(WithAxes({1, 0, 2}, {1, 1, 1})), HasSubstr("lies along y and must lie along x: swap"));
  EXPECT_THAT(SidesFault(WithAxes({2, 1, 0}, {1, 1, 1})), HasSubstr("lies along z and must lie along x: swap"));
  EXPECT_THAT(SidesFault(WithAxes({0, 1, 2}, {1, 1, -1})), HasSubstr("+z must be superior"));
  EXPECT_THAT(SidesFault(WithAxes({0, 1, 2}, {1, -1, 1})), HasSubstr("+y must be posterior"));
  EXPECT_THAT(SidesFault(WithAxes({0, 1, 2}, {-1, -1, 1})), HasSubstr("space=ras"));
  // The generated heart is small: its side is doubted, not refused.
  const auto mirrored = FindSides(WithAxes({0, 1, 2}, {-1, 1, 1}));
  ASSERT_TRUE(mirrored.ok()) << mirrored.status();
  EXPECT_THAT(mirrored->doubts, testing::ElementsAre(HasSubstr("+x is the patient's left")));
}

TEST(Sides, AreRefusedForTooFewPointsTheWrongUnitAndOneLung) {
  Points points = SyntheticPerson().exhale;
  EXPECT_THAT(SidesFault(points.leftCols(99)), HasSubstr("there are 99 points in the lungs; their shape needs 100"));
  EXPECT_THAT(SidesFault(1000 * points), HasSubstr("must be in mm"));
  EXPECT_THAT(SidesFault(points.leftCols(points.cols() / 2)), HasSubstr("both lungs"));
  points(1, 5) = std::nan("");
  EXPECT_THAT(SidesFault(points), HasSubstr("not a finite number"));
}

TEST(Registration, FindsTheScaleAndShiftThatMadeThePoints) {
  const LungTemplate& lung = GeneratedLungs()[kRight];
  const Eigen::Vector3d scale(0.9, 1.2, 1.1), shift(0.02, -0.03, 0.1);
  const Points points = (scale.asDiagonal() * PointsInside(kRight, 600)).colwise() + shift;
  const auto found = Register(lung, points);
  ASSERT_TRUE(found.ok()) << found.status();
  const Eigen::Vector3d size = found->scale.cwiseProduct(lung.box().sizes()),
                        made = scale.cwiseProduct(lung.box().sizes());
  EXPECT_LT((size - made).cwiseAbs().maxCoeff(), 0.012) << size.transpose() << " mm, not " << made.transpose();
  EXPECT_LT((found->ToTemplate(shift + scale.cwiseProduct(lung.box().center())) - lung.box().center()).norm(), 0.006);
  EXPECT_LT(found->outside, 0.03);
}

TEST(Registration, IsNotDrawnAwayByAFewOutliers) {
  const LungTemplate& lung = GeneratedLungs()[kLeft];
  Points points = PointsInside(kLeft, 600);
  const auto without = Register(lung, points);
  points.col(17) += Eigen::Vector3d(0.06, 0, 0);
  points.col(311) += Eigen::Vector3d(0, 0.06, 0.05);
  const auto with = Register(lung, points);
  ASSERT_TRUE(without.ok() && with.ok());
  EXPECT_LT((with->scale - without->scale).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_GT(with->farthest, 0.03);
}

TEST(Registration, RefusesPointsThatFillNoLung) {
  const Points flat = Eigen::Vector3d(1, 1, 0.1).asDiagonal() * PointsInside(kLeft, 200);
  EXPECT_THAT(std::string(Register(GeneratedLungs()[kLeft], flat).status().message()), HasSubstr("do not fill a lung"));
}

TEST(LungTemplate, KnowsTheDistanceFromItsSurface) {
  const LungTemplate& lung = GeneratedLungs()[kRight];
  for (const int vertex : {3, 100, 400}) EXPECT_NEAR(lung.DistanceAt(lung.surface().vertices.col(vertex)), 0, 0.002);
  EXPECT_GT(lung.DistanceAt(lung.box().max() + Eigen::Vector3d(0.01, 0, 0)), 0.01);
  EXPECT_LT(lung.DistanceAt(lung.box().center()), -0.01);
}

}  // namespace
}  // namespace phrenic::fit
