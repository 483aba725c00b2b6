// The two layers of a sheet, which are only seen, over its deformable middle surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/nearest.h"
#include "server/mesh/self_crossings.h"
#include "server/mesh/topology.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

constexpr double kHalf = 0.0015;  // half the thickness of shells [m]

std::string Shell(double more, int divisions) {
  const auto radius = [more](double r) { return std::to_string(r + more); };
  return "ellipsoid { radii { x: " + radius(0.06) + " y: " + radius(0.05) + " z: " + radius(0.04) +
         " } divisions: " + std::to_string(divisions) + " } ";
}

// Body 0 takes no part, so that the middle surface does not start at vertex 0. Then come the middle surface and layers.
std::shared_ptr<const Model> Layers(const std::string& middle, const std::vector<std::string>& layers,
                                    const std::string& skin = "") {
  std::string text =
      "name: 'sheet' bodies { name: 'other' role: ROLE_DEFORMABLE grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } } } "
      "bodies { name: 'middle' role: ROLE_DEFORMABLE " +
      middle + "} ";
  for (size_t i = 0; i < layers.size(); ++i) {
    text += "bodies { name: 'layer-" + std::to_string(i) + "' layer: 'layers' role: ROLE_SEEN " + layers[i] + "} ";
  }
  return CompileText(text + "motions { skin { bodies: 'layers' drivers: 'middle' mode: SKIN_MODE_SHEET " + skin +
                     "} }");
}

std::shared_ptr<const Model> Shells(int coarse = 16, int fine = 20) {
  return Layers(Shell(0, coarse), {Shell(kHalf, fine), Shell(-kHalf, fine)});
}

// A flat middle surface of 6 x 6 cells of 1 m, and points near it.
std::shared_ptr<const Model> Flat(const std::string& points) {
  return Layers("grid { columns: 7 rows: 7 u { x: 1 } v { y: 1 } } ", {"polyhedron { " + points + "} "},
                "thickness: 1 ");
}

Points Middle(const Model& model) {
  return model.rest.middleCols(model.bodies[1].first_vertex, model.bodies[1].mesh.vertices.cols());
}

State WithMiddle(const Model& model, const Points& middle) {
  State state = model.InitialState();
  state.x.middleCols(model.bodies[1].first_vertex, middle.cols()) = middle;
  return state;
}

const Points& Rest(const Model& model, int layer) { return model.bodies[2 + layer].mesh.vertices; }

Points Placed(const Model& model, const Points& middle, int layer = 0) {
  Points out(3, Rest(model, layer).cols());
  PlaceBody(model, WithMiddle(model, middle), 2 + layer, out);
  return out;
}

double Furthest(const Points& a, const Points& b) { return (a - b).colwise().norm().maxCoeff(); }

Points Jolted(const Points& rest, double by) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-by, by);
  return rest + Points::NullaryExpr(3, rest.cols(), [&] { return shift(random); });
}

// A smooth motion of all space, symmetric in x = 0.
Points Smooth(const Points& rest) {
  Points moved = rest;
  for (auto x : moved.colwise()) {
    x = Eigen::Vector3d(x.x() * (1.2 + 3 * x.z()), 0.85 * x.y() + 4 * x.x() * x.x(), x.z() - 5 * x.y() * x.y());
  }
  return moved;
}

// Scratch memory keeps the layers that were placed last: not for another state, and not for another layer.
TEST(SheetSkin, KeptMemoryGivesTheBitsOfFreshMemory) {
  const auto model = Shells();
  const Scratch kept;
  for (const double by : {0.0, 0.001, 0.001, 0.0}) {
    for (const int layer : {0, 1, 1, 0}) {
      const Points middle = Jolted(Middle(*model), by);
      Points out(3, Rest(*model, layer).cols());
      PlaceBody(*model, WithMiddle(*model, middle), 2 + layer, out, kept);
      EXPECT_TRUE(out == Placed(*model, middle, layer)) << by << " " << layer;
    }
  }
}

TEST(SheetSkin, AtRestLeavesTheLayersWhereTheyAre) {
  const auto model = Shells();
  for (const int layer : {0, 1}) {
    EXPECT_LT(Furthest(Placed(*model, Middle(*model), layer), Rest(*model, layer)), 1e-15);
  }
}

TEST(SheetSkin, FollowsARigidMotionExactly) {
  const auto model = Shells();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  const auto moved = [&turn](const Points& x) { return Points((turn * x).colwise() + Eigen::Vector3d(0.4, 0.5, -6)); };
  for (const int layer : {0, 1}) {
    EXPECT_LT(Furthest(Placed(*model, moved(Middle(*model)), layer), moved(Rest(*model, layer))), 1e-14);
  }
}

// Also beyond the border.
TEST(SheetSkin, UniformStretchInThePlaneThinsByItsArea) {
  const auto model =
      Flat("vertices { x: 0.3 y: 1.7 z: 0.3 } vertices { x: 6.2 y: 0.05 z: -0.4 } vertices { x: 2 y: 3 }");
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  stretch.topLeftCorner<2, 2>() << 1.3, 0.4, -0.2, 0.7;
  stretch(2, 2) = 1 / stretch.topLeftCorner<2, 2>().determinant();
  EXPECT_LT(Furthest(Placed(*model, stretch * Middle(*model)), stretch * Rest(*model, 0)), 1e-14);
  const Eigen::Matrix3d twice = Eigen::Vector3d(2, 2, 0.25).asDiagonal();
  EXPECT_LT(Furthest(Placed(*model, twice * Middle(*model)), twice * Rest(*model, 0)), 1e-14);
}

// The volume between the layers, which is small between large ones.
TEST(SheetSkin, KeepsTheVolumeOfTheSheet) {
  const auto model = Shells(24, 24);
  const auto volume = [&](const Points& middle) {
    const Triangles& triangles = model->bodies[2].mesh.triangles;
    return SignedVolume(Placed(*model, middle, 0), triangles) - SignedVolume(Placed(*model, middle, 1), triangles);
  };
  const double rest = volume(Middle(*model));
  for (const Eigen::Vector3d& stretch : {Eigen::Vector3d(1.3, 1.3, 1.3), Eigen::Vector3d(0.8, 0.8, 0.8),
                                         Eigen::Vector3d(1.3, 0.9, 1.1), Eigen::Vector3d(1, 1, 0.7)}) {
    EXPECT_NEAR(volume(stretch.asDiagonal() * Middle(*model)), rest, 0.01 * rest) << stretch.transpose();
  }
  EXPECT_NEAR(volume(Smooth(Middle(*model))), rest, 0.03 * rest);
}

TEST(SheetSkin, MirroredMotionGivesTheMirroredLayers) {
  const auto model = Shells();
  for (const int layer : {0, 1}) {
    const Points placed = Placed(*model, Smooth(Middle(*model)), layer);
    const NearestSearch search(placed);
    EXPECT_GT(Furthest(placed, Rest(*model, layer)), 0.01);
    for (const Eigen::Vector3d x : placed.colwise()) {
      EXPECT_LT(search.Nearest({-x.x(), x.y(), x.z()}).distance, 1e-12);
    }
  }
}

// A line of points beside the sheet, across its triangles: however the sheet is bent, it stays a line without a gap.
TEST(SheetSkin, IsContinuousAcrossTheEdges) {
  std::string line;
  constexpr int kPoints = 6000;
  for (int i = 0; i <= kPoints; ++i) {
    line += "vertices { x: " + std::to_string(6.0 * i / kPoints) + " y: " + std::to_string(4.4 * i / kPoints) +
            " z: 0.2 } ";
  }
  const auto model = Flat(line);
  const Points bent = Placed(*model, Jolted(Middle(*model), 0.2));
  const double longest = (bent.rightCols(kPoints) - bent.leftCols(kPoints)).colwise().norm().maxCoeff();
  EXPECT_LT(longest, 4 * std::hypot(6.0, 4.4) / kPoints);
}

// A strip 3 mm thick and 20 mm long, rolled up to radii down to 3 mm.
TEST(SheetSkin, LayersOfASmoothBendDoNotCross) {
  const auto strip = [](double z, int columns, double cell, int rows) {
    return "grid { columns: " + std::to_string(columns) + " rows: " + std::to_string(rows) +
           " origin { z: " + std::to_string(z) + " } u { x: " + std::to_string(cell) +
           " } v { y: " + std::to_string(cell) + " } } ";
  };
  const auto model = Layers(strip(0, 21, 0.001, 6), {strip(kHalf, 31, 0.02 / 30, 8), strip(-kHalf, 31, 0.02 / 30, 8)});
  for (const double radius : {0.02, 0.006, 0.004}) {
    Points bent = Middle(*model);
    for (auto x : bent.colwise()) {
      const double angle = x.x() / radius;
      x = Eigen::Vector3d(radius * std::sin(angle), x.y(), radius * (1 - std::cos(angle)));
    }
    Mesh both;
    both.vertices.resize(3, 2 * Rest(*model, 0).cols());
    both.vertices << Placed(*model, bent, 0), Placed(*model, bent, 1);
    const Triangles& triangles = model->bodies[2].mesh.triangles;
    both.triangles.resize(3, 2 * triangles.cols());
    both.triangles << triangles, Triangles(triangles.array() + static_cast<int>(Rest(*model, 0).cols()));
    EXPECT_EQ(SelfCrossings(both, 0.001), 0) << radius;
    const double apart = (Placed(*model, bent, 0) - Placed(*model, bent, 1)).colwise().norm().minCoeff();
    EXPECT_GT(apart, 1.9 * kHalf) << radius;
  }
}

TEST(SheetSkin, VelocityIsTheDerivativeOfPosition) {
  constexpr double kStep = 1e-6;
  const auto model = Shells(8, 9);
  State state = WithMiddle(*model, Jolted(Smooth(Middle(*model)), 0.001));
  state.v = Jolted(Points::Zero(3, state.x.cols()), 0.1);
  const BodyPoints body(*model, 2);
  const auto at = [&](double time) {
    State moved = state;
    moved.x += time * state.v;
    return Points(body.Positions(MakeEvalContext(*model, model->parameters, moved)));
  };
  const Points rates = (at(kStep) - at(-kStep)) / (2 * kStep);
  const Scratch scratch;
  const BodyPoints::Moving moving = body.Locate(MakeEvalContext(*model, model->parameters, state, scratch));
  EXPECT_LT(Furthest(moving.v, rates), 1e-7);
  EXPECT_EQ(Furthest(moving.x, at(0)), 0);
}

TEST(SheetSkin, CollapsedTrianglesStayFinite) {
  const auto model = Shells(8, 9);
  State state = WithMiddle(*model, Points::Zero(3, Middle(*model).cols()));
  const Scratch scratch;
  const BodyPoints::Moving moving =
      BodyPoints(*model, 2).Locate(MakeEvalContext(*model, model->parameters, state, scratch));
  EXPECT_TRUE(moving.x.allFinite() && moving.v.allFinite());
  EXPECT_LT(moving.x.cwiseAbs().maxCoeff(), 9 * kHalf) << "a sheet thickens at most eightfold";
}

TEST(SheetSkin, ReportsHowFarTheLayersLie) {
  const auto model = Flat("vertices { x: 0.3 y: 1.7 z: 0.1 } vertices { x: 2.9 y: 0.05 z: -0.3 }");
  const v1::MappingReport& report = model->report.mappings(0);
  EXPECT_EQ(report.body(), "layer-0");
  EXPECT_NEAR(report.mean_distance_mm(), 200, 1e-9);
  EXPECT_NEAR(report.largest_distance_mm(), 300, 1e-9);
  EXPECT_THAT(model->report.elements(0).detail(), testing::HasSubstr("mean distance 2e+02 mm at rest"));
}

std::string RejectionOf(const std::string& middle, const std::string& layer) {
  const auto made =
      TryCompileText("name: 'x' bodies { name: 'middle' " + middle + "} bodies { name: 'fine' role: ROLE_SEEN " +
                     layer + "} motions { skin { bodies: 'fine' drivers: 'middle' mode: SKIN_MODE_SHEET } }");
  EXPECT_EQ(made.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(made.status().message());
}

TEST(SheetSkin, RejectsLayersThatAreNotOfTheSheet) {
  const std::string sheet = "role: ROLE_DEFORMABLE grid { columns: 3 rows: 3 u { x: 0.1 } v { y: 0.1 } } ";
  EXPECT_THAT(RejectionOf(sheet, "polyhedron { vertices { z: 0.003 } vertices { x: 0.1 z: 0.0031 } } "),
              testing::HasSubstr("motions[0].skin.thickness: vertex 1 of body \"fine\" is 3.1 mm from the drivers"));
  EXPECT_THAT(RejectionOf("role: ROLE_AT_REST grid { columns: 3 rows: 3 u { x: 0.1 } v { y: 0.1 } } ",
                          "polyhedron { vertices {} } "),
              testing::HasSubstr("motions[0].skin.drivers: body \"middle\" is not ROLE_DEFORMABLE"));
}

}  // namespace
}  // namespace phrenic
