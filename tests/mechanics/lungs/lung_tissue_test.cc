#include "server/mechanics/lungs/lung_tissue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "server/mesh/ellipsoid.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

constexpr double kFree = std::numeric_limits<double>::quiet_NaN();

// About as large as a lung; its rotations are determined by its shape.
Mesh LungShape() { return EllipsoidSurface({0.07, 0.01, 0.25}, {0.05, 0.08, 0.12}, 24, false); }

LungTissue Tissue(const Mesh& surface, const LungElasticity& elasticity = {}) {
  absl::StatusOr<LungTissue> tissue = LungTissue::Make(surface, elasticity);
  if (!tissue.ok()) throw std::runtime_error(std::string(tissue.status().message()));
  return *std::move(tissue);
}

// n . d at the boundary points.
Eigen::VectorXd NormalPart(const LungTissue& tissue, const Points& displacement) {
  return tissue.normals().cwiseProduct(displacement).colwise().sum();
}

// The lower part goes down, the rest stays where it is: a breath.
Eigen::VectorXd Breath(const LungTissue& tissue) {
  const double middle = tissue.box().center().z();
  Eigen::VectorXd g(tissue.points().cols());
  for (Eigen::Index p = 0; p < g.size(); ++p) {
    g[p] = tissue.points()(2, p) < middle - 0.03 ? -0.01 * tissue.normals()(2, p) : 0;
  }
  return g;
}

TEST(LungTissue, FollowsARigidMotion) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  const Eigen::Vector3d shift(0.003, -0.002, -0.01), turn(0.01, -0.02, 0.015);
  const auto moved = [&](const Points& x) -> Points {
    Points u(3, x.cols());
    for (Eigen::Index i = 0; i < x.cols(); ++i) u.col(i) = shift + turn.cross(x.col(i) - tissue.box().center());
    return u;
  };
  const Points nodes = tissue.Solve(NormalPart(tissue, moved(tissue.points())));
  EXPECT_LT((nodes - moved(tissue.grid().nodes())).cwiseAbs().maxCoeff(), 1e-6);
}

// A ball whose surroundings widen by g: E a/(1 - 2 nu) = k (g - a R).
TEST(LungTissue, ExpandsUniformlyInAWideningBall) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; the tests below factorise smaller lungs";
#endif
  const double radius = 0.08, g = 0.004;
  const Mesh ball = EllipsoidSurface({0, 0, 0}, Eigen::Vector3d::Constant(radius), 32, false);
  for (const double poisson : {0.1, 0.3, 0.45}) {
    const LungElasticity elasticity = {.poisson = poisson, .contact = 100};
    const LungTissue tissue = Tissue(ball, elasticity);
    const Points nodes = tissue.Solve(Eigen::VectorXd::Constant(tissue.points().cols(), g));
    const double expected = elasticity.contact * g / (elasticity.contact * radius + 1 / (1 - 2 * poisson));
    for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.03, 0.02, -0.04)}) {
      const Eigen::Matrix3d error = tissue.GradientAt(nodes, point) - expected * Eigen::Matrix3d::Identity();
      EXPECT_LT(error.norm(), 0.03 * expected) << poisson;
    }
  }
}

// Betti: the work of one breath's springs on another's displacement is mutual.
TEST(LungTissue, RespondsSymmetrically) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-0.01, 0.01);
  const Eigen::VectorXd first = Breath(tissue);
  const Eigen::VectorXd second = Eigen::VectorXd::NullaryExpr(first.size(), [&] { return value(random); });
  const auto work = [&](const Eigen::VectorXd& on, const Eigen::VectorXd& by) {
    const Points nodes = tissue.Solve(by);
    Points u(3, on.size());
    for (Eigen::Index p = 0; p < on.size(); ++p) u.col(p) = tissue.DisplacementAt(nodes, tissue.points().col(p));
    return tissue.areas().cwiseProduct(on).dot(NormalPart(tissue, u));
  };
  const double mutual = work(first, second);
  EXPECT_NEAR(work(second, first), mutual, 1e-9 * std::abs(mutual));
}

TEST(LungTissue, RespondsLinearly) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  const Eigen::VectorXd breath = Breath(tissue), wider = Eigen::VectorXd::Constant(breath.size(), 0.002);
  const Points sum = 2 * tissue.Solve(breath) + tissue.Solve(wider);
  EXPECT_LT((tissue.Solve(2 * breath + wider) - sum).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(LungTissue, TakesTheLeastEnergy) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  const Eigen::VectorXd g = Breath(tissue);
  const Points boundary = tissue.normals() * g.asDiagonal();
  const Points nodes = tissue.Solve(g);
  const double least = tissue.Energy(nodes, boundary);
  EXPECT_LT(least, tissue.Energy(Points::Zero(3, nodes.cols()), boundary));
  std::mt19937 random(2);
  std::normal_distribution<double> value(0, 1e-4);
  for (int i = 0; i < 5; ++i) {
    const Points other = nodes + Points::NullaryExpr(3, nodes.cols(), [&] { return value(random); });
    EXPECT_LT(least, tissue.Energy(other, boundary));
  }
}

TEST(LungTissue, HardlyChangesWithSmallerBricks) {
#ifdef PHRENIC_SANITIZED
  GTEST_SKIP() << "the Release build runs it; the tests below factorise smaller lungs";
#endif
  const LungTissue coarse = Tissue(LungShape()), fine = Tissue(LungShape(), {.edge = 0.01});
  const Points of_coarse = coarse.Solve(Breath(coarse)), of_fine = fine.Solve(Breath(fine));
  double largest = 0, sum = 0;
  int count = 0;
  for (Eigen::Index p = 0; p < coarse.points().cols(); p += 7) {
    const Eigen::Vector3d inside = coarse.box().center() + 0.9 * (coarse.points().col(p) - coarse.box().center());
    const double change = (coarse.DisplacementAt(of_coarse, inside) - fine.DisplacementAt(of_fine, inside)).norm();
    largest = std::max(largest, change);
    sum += change;
    ++count;
  }
  EXPECT_LT(sum / count, 0.01 * 0.01);  // of a descent of 10 mm
  EXPECT_LT(largest, 0.06 * 0.01);
}

// The properties that determine the motion of real lungs: ../shared/motion.md.
TEST(LungTissue, MovesFartherWhereItSlidesThanGlued) {
  const LungTissue sliding = Tissue(LungShape(), {.edge = 0.02});
  const LungTissue glued = Tissue(LungShape(), {.edge = 0.02, .tangential = 500});
  const Eigen::VectorXd g = Breath(sliding);
  const Points boundary = sliding.normals() * g.asDiagonal();
  const Eigen::Vector3d middle = sliding.box().center();
  const double slides = sliding.DisplacementAt(sliding.SolveVectors(boundary), middle).z();
  const double sticks = glued.DisplacementAt(glued.SolveVectors(boundary), middle).z();
  EXPECT_LT(slides, -0.003);
  EXPECT_GT(sticks, 0.7 * slides);
}

TEST(LungTissue, IsFreeWhereNothingTouchesIt) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  Eigen::VectorXd g = Breath(tissue);
  const double middle = tissue.box().center().z();
  const double held = tissue.DisplacementAt(tissue.Solve(g), tissue.box().center()).z();
  for (Eigen::Index p = 0; p < g.size(); ++p) {
    if (tissue.points()(2, p) > middle) g[p] = kFree;
  }
  const Points nodes = tissue.Solve(g);
  EXPECT_LT(tissue.DisplacementAt(nodes, tissue.box().center()).z(), 1.2 * held);
  const Points alone = tissue.Solve(Eigen::VectorXd(NormalPart(tissue, Points::Constant(3, g.size(), 0.01))));
  EXPECT_NEAR(tissue.DisplacementAt(alone, tissue.box().center()).x(), 0.01, 1e-6);
}

// A ball that nothing touches, under a pressure p = E: p = 3 K e.
TEST(LungTissue, ExpandsUniformlyUnderAPressure) {
  const LungTissue ball =
      Tissue(EllipsoidSurface({0, 0, 0}, Eigen::Vector3d::Constant(0.08), 32, false), {.edge = 0.02});
  const PressedLung lung = ball.SolvePressed(Points::Constant(3, ball.points().cols(), kFree));
  const double expected = 1 - 2 * LungElasticity().poisson;
  for (const Eigen::Vector3d& point : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.03, 0.02, -0.04)}) {
    const Eigen::Matrix3d strain = ball.GradientAt(lung.pressed, point);
    EXPECT_LT(((strain + strain.transpose()) / 2 - expected * Eigen::Matrix3d::Identity()).norm(), 0.05 * expected);
  }
  EXPECT_LT(lung.followed.cwiseAbs().maxCoeff(), 1e-12);
}

// What touches a lung is where it is, whatever presses.
TEST(LungTissue, IsPressedWhereItIsFreeAlone) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  const PressedLung lung = tissue.SolvePressed(Points::Zero(3, tissue.points().cols()));
  EXPECT_EQ(lung.pressed.cwiseAbs().maxCoeff(), 0);
}

// The root holds the tissue along the surface too.
TEST(LungTissue, FollowsWhatHoldsItsRoot) {
  LungElasticity elasticity = {.edge = 0.02};
  const LungTissue rootless = Tissue(LungShape(), elasticity);
  elasticity.root = {1, rootless.box()};
  const LungTissue rooted = Tissue(LungShape(), elasticity);
  Points shift = Points::Zero(3, rooted.points().cols());
  Eigen::Index inner = -1;
  for (Eigen::Index p = 0; p < shift.cols(); ++p) {
    EXPECT_FALSE(rootless.rooted()[static_cast<size_t>(p)]);
    if (!rooted.rooted()[static_cast<size_t>(p)]) continue;
    shift(2, p) = -0.01;
    if (inner < 0 || rooted.normals()(0, p) < rooted.normals()(0, inner)) inner = p;
  }
  ASSERT_GE(inner, 0);
  const Eigen::Vector3d at = rooted.points().col(inner);
  EXPECT_LT(rooted.DisplacementAt(rooted.SolveVectors(shift), at).z(), -0.006);
  EXPECT_GT(rootless.DisplacementAt(rootless.SolveVectors(shift), at).z(), -0.003);
}

TEST(LungRoot, IsBehindTheMiddleOfTheMedialSide) {
  const LungRoot right = {-1, {Eigen::Vector3d(-0.12, -0.09, 0.17), Eigen::Vector3d(-0.01, 0.09, 0.39)}};
  const Eigen::Vector3d medial(1, 0, 0), hilum(-0.02, 0.02, 0.285);
  EXPECT_TRUE(right.Holds(hilum, medial));
  EXPECT_FALSE(right.Holds(hilum, -medial)) << "the lateral side";
  EXPECT_FALSE(right.Holds(hilum + Eigen::Vector3d(0, -0.05, 0), medial)) << "in front of it";
  EXPECT_FALSE(right.Holds(hilum + Eigen::Vector3d(0, 0, -0.05), medial)) << "the ligament";
  EXPECT_FALSE(LungRoot().Holds(hilum, medial));
}

TEST(LungTissue, FollowsAsWithoutAPressure) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  Points boundary = tissue.normals() * Breath(tissue).asDiagonal();
  boundary.leftCols(20).setConstant(kFree);
  const PressedLung lung = tissue.SolvePressed(boundary);
  EXPECT_LT((lung.followed - tissue.SolveVectors(boundary)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LungTissue, KnowsWhatItContains) {
  const LungTissue tissue = Tissue(LungShape(), {.edge = 0.02});
  EXPECT_TRUE(tissue.Contains(tissue.box().center()));
  EXPECT_FALSE(tissue.Contains(tissue.box().max() - Eigen::Vector3d::Constant(1e-3)));
  EXPECT_FALSE(tissue.Contains(tissue.box().max() + Eigen::Vector3d::Ones()));
}

TEST(LungTissue, RejectsWhatIsNoLung) {
  Mesh open = LungShape(), inside_out = LungShape();
  open.triangles.conservativeResize(3, open.triangles.cols() - 1);
  inside_out.triangles.row(0).swap(inside_out.triangles.row(1));
  EXPECT_THAT(LungTissue::Make(open).status().message(), HasSubstr("must be closed"));
  EXPECT_THAT(LungTissue::Make(inside_out).status().message(), HasSubstr("face outwards"));
  EXPECT_FALSE(LungTissue::Make({}).ok());
  Mesh in_millimetres = LungShape();
  in_millimetres.vertices *= 1000;
  EXPECT_THAT(LungTissue::Make(in_millimetres).status().message(), HasSubstr("check the surface's unit"));
}

TEST(LungTissue, ErrorsOfNumbersNameTheFieldTheRangeAndTheRemedy) {
  const std::pair<LungElasticity, const char*> faults[] = {
      {{.edge = kFree}, "edge: nan is outside 0.0001 to 1 m; set a number within"},
      {{.poisson = 0.5}, "poisson: 0.5 is outside 0 to 0.49; set"},
      {{.contact = 0}, "contact: 0 is outside 0.001 to 1e+06 1/m; set"},
      {{.tangential = -1}, "tangential: -1 is outside 0 to 1e+06 1/m; set"},
      {{.weight = {.rise = {0, 0, 21}}}, "weight.rise: 21 is outside 0 to 20 1/m; set"},
      {{.weight = {.room = -1}}, "weight.room: -1 is outside 0 to 100; set"},
  };
  for (const auto& [elasticity, words] : faults) {
    EXPECT_THAT(LungTissue::Make(LungShape(), elasticity).status().message(), HasSubstr(words));
  }
}

TEST(LungTissue, IsNotFactorisedForCallersThatHaveGone) {
  const StopCheck gone([] { return true; }, 0, "");
  EXPECT_TRUE(absl::IsCancelled(LungTissue::Make(LungShape(), {}, gone).status()));
}

}  // namespace
}  // namespace phrenic
