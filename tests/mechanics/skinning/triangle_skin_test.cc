// A fine surface that rides on the triangles of a coarse one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/skinning/body_points.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// A coarse dome, and a seen one over it.
std::shared_ptr<const Model> Domes(int coarse, int fine) {
  const auto dome = [](int divisions) {
    return "ellipsoid { radii { x: 0.12 y: 0.09 z: 0.07 } divisions: " + std::to_string(divisions) +
           " upper_half: true } ";
  };
  return CompileText("name: 'domes' bodies { name: 'coarse' role: ROLE_DEFORMABLE " + dome(coarse) +
                     "} bodies { name: 'fine' role: ROLE_SEEN " + dome(fine) +
                     "} motions { skin { bodies: 'fine' drivers: 'coarse' mode: SKIN_MODE_TRIANGLES } }");
}

// A coarse sheet of 3 x 3 cells of 1 m, and points over it.
std::string SheetText(const std::string& points) {
  return "name: 'sheet' bodies { name: 'coarse' role: ROLE_DEFORMABLE grid { columns: 4 rows: 4 u { x: 1 } v { y: 1 } "
         "} } bodies { name: 'fine' role: ROLE_SEEN polyhedron { " +
         points + " } } motions { skin { bodies: 'fine' drivers: 'coarse' mode: SKIN_MODE_TRIANGLES } }";
}

Points Carried(const Model& model, const Points& x) {
  State state = model.InitialState();
  state.x = x;
  Points out(3, model.bodies[1].mesh.vertices.cols());
  PlaceBody(model, state, 1, out);
  return out;
}

const Points& Fine(const Model& model) { return model.bodies[1].mesh.vertices; }

Points Shaken(const Points& rest, double by) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-by, by);
  return rest + Points::NullaryExpr(3, rest.cols(), [&] { return shift(random); });
}

double LargestDistance(const Points& a, const Points& b) { return (a - b).colwise().norm().maxCoeff(); }

TEST(Mapping, AtRestLeavesTheFineSurfaceWhereItIs) {
  const auto model = Domes(3, 10);
  EXPECT_LT(LargestDistance(Carried(*model, model->rest), Fine(*model)), 1e-15);
}

TEST(Mapping, FollowsARigidMotionExactly) {
  const auto model = Domes(3, 10);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  const auto moved = [&turn](const Points& x) { return Points((turn * x).colwise() + Eigen::Vector3d(4, 5, -6)); };
  EXPECT_LT(LargestDistance(Carried(*model, moved(model->rest)), moved(Fine(*model))), 1e-14);
}

TEST(Mapping, IsTheIdentityWhereFineIsCoarse) {
  const auto model = Domes(5, 5);
  const Points x = Shaken(model->rest, 0.01);
  EXPECT_LT(LargestDistance(Carried(*model, x), x), 1e-15);
}

TEST(Mapping, CarriesEvenStretchesExactlyInThePlane) {
  const auto model = CompileText(SheetText("vertices { x: 0.3 y: 1.7 } vertices { x: 2.9 y: 0.05 z: 0.4 }"));
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  stretch.topLeftCorner<2, 2>() << 1.3, 0.4, -0.2, 0.7;
  EXPECT_LT(LargestDistance(Carried(*model, stretch * model->rest), stretch * Fine(*model)), 1e-14);
}

// Over all directions the largest error of a stretch by 1 % is what the report says, but for terms of second order.
TEST(Mapping, ReportsTheErrorOfAnEvenStretch) {
  const auto model = Domes(3, 10);
  double largest = 0;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d d = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity() + 0.01 * d * d.transpose();
    largest =
        std::max(largest, LargestDistance(Carried(*model, stretch * model->rest), stretch * Points(Fine(*model))));
  }
  ASSERT_EQ(model->report.mappings_size(), 1);
  EXPECT_NEAR(1e3 * largest, model->report.mappings(0).largest_strain_error_mm(), 0.03 * 1e3 * largest);
}

TEST(Mapping, ReportsHowFarTheFineSurfaceLies) {
  const auto model = CompileText(SheetText("vertices { x: 0.3 y: 1.7 z: 0.01 } vertices { x: 2.9 y: 0.05 z: -0.03 }"));
  const v1::MappingReport& report = model->report.mappings(0);
  EXPECT_EQ(report.body(), "fine");
  EXPECT_NEAR(report.mean_distance_mm(), 20, 1e-9);
  EXPECT_NEAR(report.largest_distance_mm(), 30, 1e-9);
  EXPECT_THAT(model->report.elements(0).detail(), testing::HasSubstr("mean distance 20 mm at rest, largest 30 mm"));
}

// A line of points on the sheet, across its triangles: however the sheet is bent, it stays a line without a gap.
TEST(Mapping, IsContinuousAcrossTheEdges) {
  std::string line;
  constexpr int kPoints = 3000;
  for (int i = 0; i <= kPoints; ++i) {
    line += "vertices { x: " + std::to_string(3.0 * i / kPoints) + " y: " + std::to_string(2.2 * i / kPoints) + " } ";
  }
  const auto model = CompileText(SheetText(line));
  const Points bent = Carried(*model, Shaken(model->rest, 0.3));
  const double longest = (bent.rightCols(kPoints) - bent.leftCols(kPoints)).colwise().norm().maxCoeff();
  EXPECT_LT(longest, 4 * std::hypot(3.0, 2.2) / kPoints);
}

TEST(Mapping, NeedsTrianglesThatMove) {
  const auto made = TryCompileText(
      "name: 'x' bodies { name: 'rod' role: ROLE_DEFORMABLE polyhedron { vertices {} vertices { x: 1 } edges { a: 0 b: "
      "1 } } } bodies { name: 'fine' role: ROLE_SEEN polyhedron { vertices {} } } motions { skin { bodies: 'fine' "
      "drivers: 'rod' mode: SKIN_MODE_TRIANGLES } }");
  EXPECT_EQ(made.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(made.status().message()), testing::HasSubstr("motions[0].skin.drivers: body \"rod\""));
}

}  // namespace
}  // namespace phrenic
