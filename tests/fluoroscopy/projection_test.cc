// Line integrals of bodies whose thickness is known.
#include "server/fluoroscopy/projection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/fluoroscopy/closing.h"
#include "server/mesh/ellipsoid.h"

namespace phrenic::fluoroscopy {
namespace {

constexpr int kSize = 96;
constexpr double kRadius = 0.1;  // [m]

Absorber Ball(double radius, double weight, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero()) {
  const Mesh mesh = EllipsoidSurface(centre, Eigen::Vector3d::Constant(radius), 100, false);
  return {"ball", mesh.vertices, mesh.triangles, weight};
}

// A box around the origin.
Absorber Box(const Eigen::Vector3d& half, double weight) {
  Absorber box{"box", Points(3, 8), Triangles(3, 12), weight};
  for (int i = 0; i < 8; ++i) {
    box.vertices.col(i) = half.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  box.triangles << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,               //
      3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return box;
}

// Where the ray through the middle of a pixel crosses the plane of the isocentre, to the right and up [m].
Eigen::Vector2d PlaceOf(int row, int column) {
  const double pixel = 2 * kFieldHalfWidth / kSize;
  return {(column + 0.5 - kSize / 2.0) * pixel, (kSize / 2.0 - row - 0.5) * pixel};
}

// The length of the ray's chord in a ball around the isocentre [m].
double Chord(const Projection& at, int row, int column, double radius) {
  const Eigen::Vector2d place = PlaceOf(row, column);
  double miss = place.norm();
  if (at.source_distance > 0) miss *= at.source_distance / std::hypot(at.source_distance, miss);
  return miss < radius ? 2 * std::sqrt(radius * radius - miss * miss) : 0;
}

class Rays : public testing::TestWithParam<CArm> {
 protected:
  Projection at_ = ProjectionOf(GetParam(), Eigen::Vector3d::Zero());
};

TEST_P(Rays, PassThroughABallAlongItsChords) {
  const Picture picture = LineIntegrals({Ball(kRadius, 2)}, at_, kSize);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double chord = Chord(at_, row, column, kRadius);
      // Within one per cent; near its edge the polyhedron is flat.
      EXPECT_NEAR(picture(row, column), 2 * chord, 2 * (chord > kRadius / 2 ? 0.01 * chord : 0.005))
          << row << " " << column;
    }
  }
}

TEST_P(Rays, AddABallWithinABallByItsDifference) {
  const Picture outer = LineIntegrals({Ball(kRadius, 20)}, at_, kSize),
                inner = LineIntegrals({Ball(kRadius / 2, -15)}, at_, kSize),
                both = LineIntegrals({Ball(kRadius, 20), Ball(kRadius / 2, 5 - 20.0)}, at_, kSize);
  EXPECT_LT((both - outer - inner).abs().maxCoeff(), 1e-12);
  const int middle = kSize / 2;
  EXPECT_NEAR(both(middle, middle), 20 * kRadius + 5 * kRadius, 0.02) << "half of the way at 20/m, half at 5/m";
}

INSTANTIATE_TEST_SUITE_P(, Rays,
                         testing::Values(CArm{.source_to_detector = 0}, CArm{}, CArm{30, 0, 1.8}, CArm{-45, 20, 1},
                                         CArm{90, -30, 0}, CArm{180, 0, 1.2}));

TEST(Slab, HasItsThicknessOverTheCosineOfTheAngle) {
  const Absorber slab = Box({1, 0.03, 1}, 1);
  for (const double lao : {0.0, 20.0, 45.0}) {
    const CArm parallel{lao, 0, 0};
    const Picture picture = LineIntegrals({slab}, ProjectionOf(parallel, Eigen::Vector3d::Zero()), kSize);
    const double wanted = 0.06 / std::cos(lao * M_PI / 180);
    EXPECT_LT((picture - wanted).abs().maxCoeff(), 1e-9) << lao;
  }
  const Projection cone = ProjectionOf({}, Eigen::Vector3d::Zero());
  const Picture picture = LineIntegrals({slab}, cone, kSize);
  for (int i = 0; i < kSize; ++i) {
    const double wanted = 0.06 * std::hypot(cone.source_distance, PlaceOf(i, i).norm()) / cone.source_distance;
    EXPECT_NEAR(picture(i, i), wanted, 1e-9);
  }
}

// Pixels on edges and vertices count once: vertices lie on the middles of pixels.
TEST(ClosedSurface, LeavesNothingBesideItselfAndNoSeams) {
  const double pixel = 2 * kFieldHalfWidth / kSize;
  const Absorber box = Box({10.5 * pixel, 0.05, 10.5 * pixel}, 1);
  const Picture picture = LineIntegrals({box}, ProjectionOf({.source_to_detector = 0}, Eigen::Vector3d::Zero()), kSize);
  for (const double value : picture.reshaped()) EXPECT_TRUE(std::abs(value) < 1e-12 || std::abs(value - 0.1) < 1e-12);
  EXPECT_NEAR(picture.sum() / 0.1, 21 * 21, 1e-9);
}

// Surfaces of scans lack a few triangles: the gaps are closed, and leave no streaks.
TEST(ClosedTriangles, CloseSmallGapsAndRefuseSheets) {
  const Absorber ball = Ball(kRadius, 1);
  Absorber torn = ball;
  torn.triangles = ball.triangles.rightCols(ball.triangles.cols() - 7);
  const auto mended = ClosedTriangles(torn.vertices, torn.triangles);
  ASSERT_TRUE(mended.has_value());
  EXPECT_EQ(ClosedTriangles(torn.vertices, *mended)->cols(), mended->cols()) << "nothing is left to close";
  torn.triangles = *mended;
  const Projection at = ProjectionOf({20, 10, 1.8}, Eigen::Vector3d::Zero());
  EXPECT_LT((LineIntegrals({torn}, at, kSize) - LineIntegrals({ball}, at, kSize)).abs().maxCoeff(), 0.001);
  const Mesh half = EllipsoidSurface(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(kRadius), 20, true);
  EXPECT_FALSE(ClosedTriangles(half.vertices, half.triangles).has_value());
  EXPECT_FALSE(ClosedTriangles(half.vertices, Triangles(3, 0)).has_value());
}

TEST(CArm, SeesThePatientsLeftOnTheRightAndTheHeadAbove) {
  const auto brightest = [](const CArm& arm, const Eigen::Vector3d& centre) {
    const Picture picture = LineIntegrals({Ball(0.02, 1, centre)}, ProjectionOf(arm, Eigen::Vector3d::Zero()), kSize);
    Eigen::Index row, column;
    picture.maxCoeff(&row, &column);
    return PlaceOf(static_cast<int>(row), static_cast<int>(column));
  };
  EXPECT_NEAR(brightest({}, {0.1, 0, 0}).x(), 0.1, 0.005);
  EXPECT_NEAR(brightest({}, {0, 0, 0.1}).y(), 0.1, 0.005);
  EXPECT_NEAR(brightest(*NamedArm("left-lateral"), {0, -0.1, 0}).x(), -0.1, 0.005) << "the front is on the left";
  EXPECT_NEAR(brightest(*NamedArm("ap"), {0.1, 0, 0}).x(), -0.1, 0.005) << "shown mirrored";
  EXPECT_TRUE(IsMirrored(*NamedArm("ap")));
  // What is near the detector is smaller: the heart is larger from front to back.
  EXPECT_LT(brightest({}, {0.1, -0.1, 0}).x(), brightest({}, {0.1, 0.1, 0}).x());
  // The front moves to the patient's right in the picture of an arm on the left.
  EXPECT_LT(brightest(*NamedArm("lao-30"), {0, -0.1, 0}).x(), -0.03);
  EXPECT_FALSE(NamedArm("oblique").ok());
}

}  // namespace
}  // namespace phrenic::fluoroscopy
