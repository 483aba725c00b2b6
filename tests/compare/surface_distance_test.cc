#include "server/compare/surface_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "server/mesh/ellipsoid.h"
#include "tests/compare/surfaces.h"

namespace phrenic::compare {
namespace {

using ::testing::HasSubstr;

v1::SurfaceDistance Distance(const Mesh& a, const Mesh& b, const DistanceOptions& options = {}) {
  const auto distance = MeasureDistance(Measured(a), Measured(b), options);
  EXPECT_TRUE(distance.ok()) << distance.status();
  return distance.value_or(v1::SurfaceDistance());
}

Mesh Sphere(double radius, int cells) {
  return EllipsoidSurface(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(radius), cells, false);
}

// |2 mm cos| is uniformly distributed over a sphere's area: maximum 2, mean 1, RMS 2/sqrt(3), 95th percentile 1.9.
TEST(SurfaceDistance, OfASphereMovedByTwoMillimetresMatchesTheClosedForm) {
  const Mesh sphere = Sphere(0.1, 64);
  const v1::SurfaceDistance distance = Distance(sphere, Moved(sphere, {0, 0, 0.002}), {.tolerance = 1e-3});
  EXPECT_NEAR(distance.hd_max(), 2, 0.002);
  EXPECT_NEAR(distance.hd_max_bound(), distance.hd_max(), 0.001);
  for (const double mean : {distance.mean_a_to_b(), distance.mean_b_to_a(), distance.assd()}) {
    EXPECT_NEAR(mean, 1, 0.005);
  }
  for (const double rms : {distance.rms_a_to_b(), distance.rms_b_to_a()}) EXPECT_NEAR(rms, 1.1547, 0.006);
  for (const double p95 : {distance.p95_a_to_b(), distance.hd95_max(), distance.hd95_pooled()}) {
    EXPECT_NEAR(p95, 1.9, 0.01);
  }
  EXPECT_NEAR(distance.surface_dice(), 0.5, 0.01) << "half of the area is within 1 mm";
  EXPECT_NEAR(distance.area_a(), 4e4 * M_PI, 200);
}

TEST(SurfaceDistance, ToItselfIsZero) {
  const Mesh sphere = Sphere(0.1, 16);
  const v1::SurfaceDistance distance = Distance(sphere, sphere);
  EXPECT_LT(distance.hd_max(), 1e-9);
  EXPECT_LT(distance.hd_max_bound(), 1e-5);
  EXPECT_EQ(distance.surface_dice(), 1);
}

TEST(SurfaceDistance, IsToTheSurfaceAndNotToItsVertices) {
  const v1::SurfaceDistance distance = Distance(Square(0.1, 1), Square(0.1, 7));
  EXPECT_LT(distance.hd_max(), 1e-9) << "the same square with another triangulation";
  EXPECT_LT(distance.assd(), 1e-9);
}

TEST(SurfaceDistance, OfParallelSquaresIsTheGapInEveryMeasure) {
  const v1::SurfaceDistance distance =
      Distance(Square(0.1, 5), Moved(Square(0.1, 5), {0, 0, 0.003}), {.tolerance = 0.0029});
  for (const double measure : {distance.hd_max(), distance.hd_max_bound(), distance.hd95_max(), distance.hd95_pooled(),
                               distance.assd(), distance.mean_a_to_b(), distance.rms_b_to_a()}) {
    EXPECT_NEAR(measure, 3, 4e-4);
  }
  EXPECT_EQ(distance.surface_dice(), 0);
  EXPECT_EQ(Distance(Square(0.1, 5), Moved(Square(0.1, 5), {0, 0, 0.003}), {.tolerance = 0.0031}).surface_dice(), 1);
}

// A square and its left half: the distance from the half to the whole is 0, from the whole to the half uniform in 0 to
// 50 mm.
TEST(SurfaceDistance, DirectionsAreKeptApartAndSwapWithTheSurfaces) {
  Mesh half = Square(0.1, 4);
  half.vertices.row(0) /= 2;
  const v1::SurfaceDistance distance = Distance(half, Square(0.1, 4));
  EXPECT_LT(distance.hd_a_to_b(), 1e-9);
  EXPECT_NEAR(distance.hd_b_to_a(), 50, 0.01);
  EXPECT_NEAR(distance.mean_b_to_a(), 12.5, 0.05) << "half of the area at 0, half at a mean of 25 mm";
  EXPECT_NEAR(distance.p95_b_to_a(), 45, 0.5);
  EXPECT_NEAR(distance.assd(), 12.5 * 2 / 3, 0.05);
  EXPECT_EQ(distance.hd_max(), distance.hd_b_to_a());
  EXPECT_EQ(distance.hd95_max(), distance.p95_b_to_a());
  EXPECT_NEAR(distance.hd95_pooled(), 50 * (1 - 0.05 * 3), 0.5) << "5 % of 15 units is 0.75 of the 10 that B has";
  const v1::SurfaceDistance swapped = Distance(Square(0.1, 4), half);
  EXPECT_EQ(swapped.mean_a_to_b(), distance.mean_b_to_a());
  EXPECT_EQ(swapped.hd_max(), distance.hd_max());
  EXPECT_EQ(swapped.hd95_pooled(), distance.hd95_pooled());
}

// The point of a 30-40-50 triangle farthest from its corners is the midpoint of the longest edge: neither a vertex nor
// a sample.
TEST(SurfaceDistance, MaximumIsRightBetweenSamples) {
  Mesh triangle;
  triangle.vertices.resize(3, 3);
  triangle.vertices << 0, 0.03, 0, 0, 0, 0.04, 0, 0, 0;
  triangle.triangles.resize(3, 1);
  triangle.triangles << 0, 1, 2;
  Mesh corners;
  corners.vertices.resize(3, 9);
  corners.triangles.resize(3, 3);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) corners.vertices.col(3 * i + k) = triangle.vertices.col(i);
    corners.triangles.col(i) << 3 * i, 3 * i + 1, 3 * i + 2;
  }
  const v1::SurfaceDistance distance = Distance(triangle, corners, {.spacing = 1});
  EXPECT_EQ(distance.samples_a(), 1);
  EXPECT_NEAR(distance.hd_a_to_b(), 25, 0.0025);
  EXPECT_GE(distance.hd_max_bound(), 25);
  EXPECT_LE(distance.hd_max_bound(), 25.01);
}

TEST(SurfaceDistance, RigidMotionChangesNothing) {
  const Mesh sphere = Sphere(0.05, 12);
  Mesh other = EllipsoidSurface({0.01, 0, 0}, {0.05, 0.06, 0.04}, 12, false);
  const v1::SurfaceDistance before = Distance(sphere, other);
  const Eigen::Isometry3d turn =
      Eigen::Translation3d(1, -2, 3) * Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized());
  Mesh turned = sphere;
  turned.vertices = turn * sphere.vertices;
  other.vertices = turn * other.vertices;
  const v1::SurfaceDistance after = Distance(turned, other);
  EXPECT_NEAR(after.assd(), before.assd(), 1e-9);
  EXPECT_NEAR(after.hd95_max(), before.hd95_max(), 1e-3);
  EXPECT_NEAR(after.hd_max(), before.hd_max(), 1e-4 * before.hd_max());
}

TEST(SurfaceDistance, OfAnEmptySurfaceIsNotANumber) {
  Mesh wire = Square(0.1, 1);
  wire.triangles.resize(3, 0);
  for (const v1::SurfaceDistance& distance :
       {Distance(wire, Square(0.1, 1)), Distance(Square(0.1, 1), wire), Distance(wire, wire)}) {
    for (const double measure :
         {distance.hd_max(), distance.hd_max_bound(), distance.hd95_max(), distance.hd95_pooled(), distance.assd(),
          distance.mean_a_to_b(), distance.mean_b_to_a(), distance.rms_a_to_b(), distance.rms_b_to_a(),
          distance.hd_a_to_b(), distance.hd_b_to_a(), distance.surface_dice()}) {
      EXPECT_TRUE(std::isnan(measure)) << distance.ShortDebugString();
    }
  }
  EXPECT_EQ(Distance(wire, Square(0.1, 1)).samples_a(), 0);
}

TEST(SurfaceDistance, OfASurfaceWithoutAreaHasAMaximumAndNoMean) {
  Mesh needle;
  needle.vertices = Points::Zero(3, 3);
  needle.vertices(2, 1) = 0.01;
  needle.triangles.resize(3, 1);
  needle.triangles << 0, 1, 2;
  const v1::SurfaceDistance distance = Distance(needle, Square(0.1, 1));
  EXPECT_NEAR(distance.hd_a_to_b(), 10, 1e-9);
  EXPECT_TRUE(std::isnan(distance.mean_a_to_b()));
  EXPECT_TRUE(std::isnan(distance.hd95_max()));
}

TEST(SurfaceDistance, SamplesKeepTheSpacingAndMeansConvergeAtSecondOrder) {
  const Mesh plane = Square(0.1, 1), dome = EllipsoidSurface({0.05, 0.05, 0}, {0.05, 0.05, 0.05}, 8, true);
  const double exact = Distance(plane, dome, {.spacing = 0.00025}).mean_a_to_b();
  const v1::SurfaceDistance coarse = Distance(plane, dome, {.spacing = 0.008});
  const v1::SurfaceDistance fine = Distance(plane, dome, {.spacing = 0.002});
  EXPECT_LE(fine.spacing_a(), 2 + 1e-9);
  EXPECT_LE(coarse.spacing_b(), 8 + 1e-9);
  EXPECT_LT(std::abs(fine.mean_a_to_b() - exact), std::abs(coarse.mean_a_to_b() - exact) / 8)
      << "the ratio tends to 16";
}

TEST(SurfaceDistance, TooFineASpacingIsRefusedWithOneThatWorks) {
  const auto fine = MeasureDistance(Measured(Square(0.1, 1)), Measured(Square(0.1, 1)), {.spacing = 1e-6});
  ASSERT_FALSE(fine.ok());
  EXPECT_EQ(fine.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(fine.status().message()), HasSubstr("spacing_mm"));
  EXPECT_THAT(std::string(fine.status().message()), HasSubstr("about 0.094 mm is the least"));
}

}  // namespace
}  // namespace phrenic::compare
