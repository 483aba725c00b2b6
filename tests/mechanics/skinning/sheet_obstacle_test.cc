// A body above a dome, which a bone holds: it gives way where the dome rises into it, and only there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/skinning/body_points.h"
#include "server/mesh/triangle_tree.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// The body rests 3 mm above a dome of 120 mm radius. `skin` has more fields of its skin.
std::string DomeUnderLung(const std::string& skin) {
  return "name: 'dome' bodies { name: 'sheet' role: ROLE_DEFORMABLE ellipsoid { radii { x: 0.12 y: 0.12 z: 0.12 } "
         "divisions: 16 upper_half: true } } "
         "bodies { name: 'bone' role: ROLE_AT_REST ellipsoid { centre { z: 0.26 } radii { x: 0.05 y: 0.05 z: 0.02 } "
         "divisions: 4 } } "
         "bodies { name: 'lung' role: ROLE_SEEN ellipsoid { centre { z: 0.173 } radii { x: 0.05 y: 0.05 z: 0.05 } "
         "divisions: 12 } } "
         "motions { skin { bodies: 'lung' drivers: 'bone' " +
         skin + " } }";
}

constexpr int kObstacleBody = 0, kLungBody = 2;

struct LungPlaces {
  Points x, v;
};

// Where the lung is after the sheet has been moved by `x - rest`, at rates `v`.
LungPlaces ObstructedLung(const Model& model, const Points& x, const Points& v) {
  State state = model.InitialState();
  state.x = x;
  state.v = v;
  const Scratch scratch;
  const auto moving = BodyPoints(model, kLungBody).Locate(MakeEvalContext(model, model.parameters, state, scratch));
  return {moving.x, moving.v};
}

Points RaisedSheet(const Model& model, double by) { return model.rest.colwise() + Eigen::Vector3d(0, 0, by); }

// Returns the least signed distance of the lung from the sheet [m], positive above.
double LeastDistance(const Model& model, const Points& sheet, const Points& lung) {
  const TriangleTree tree(sheet, model.bodies[kObstacleBody].mesh.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(sheet, boxes);
  double least = 1;
  for (const auto point : lung.colwise()) {
    const SurfacePoint nearest = tree.Nearest(sheet, boxes, point, 1);
    if (nearest.on_boundary) continue;
    least = std::min(least, (nearest.facing > 0 ? -1 : 1) * std::sqrt(nearest.squared));
  }
  return least;
}

TEST(SheetObstacle, AtRestNothingMoves) {
  const auto model = CompileText(DomeUnderLung("obstacle: 'sheet'"));
  const Points zero = Points::Zero(3, model->rest.cols());
  EXPECT_TRUE(ObstructedLung(*model, model->rest, zero).x == model->bodies[kLungBody].mesh.vertices);
}

// The cause is taken away: without the obstacle the dome comes out through the lung.
TEST(SheetObstacle, ARisingDomeDoesNotPassThrough) {
  const auto free = CompileText(DomeUnderLung("")), stopped = CompileText(DomeUnderLung("obstacle: 'sheet'"));
  const Points zero = Points::Zero(3, free->rest.cols());
  for (const double by : {0.02, 0.04}) {
    const Points sheet = RaisedSheet(*free, by);
    EXPECT_LT(LeastDistance(*free, sheet, ObstructedLung(*free, sheet, zero).x), -0.003);
    EXPECT_GT(LeastDistance(*stopped, sheet, ObstructedLung(*stopped, sheet, zero).x), 0.0009);
  }
}

TEST(SheetObstacle, WhatIsClearOfTheSheetKeepsItsBits) {
  const auto free = CompileText(DomeUnderLung("")), stopped = CompileText(DomeUnderLung("obstacle: 'sheet'"));
  const Points zero = Points::Zero(3, free->rest.cols()), sheet = RaisedSheet(*free, 0.02);
  const Points without = ObstructedLung(*free, sheet, zero).x, with = ObstructedLung(*stopped, sheet, zero).x;
  int moved = 0;
  for (Eigen::Index i = 0; i < with.cols(); ++i) {
    if (with.col(i) == without.col(i)) continue;
    ++moved;
    EXPECT_LT(without(2, i), 0.2);
  }
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, with.cols() / 2);
  EXPECT_TRUE(ObstructedLung(*stopped, RaisedSheet(*free, -0.02), zero).x ==
              ObstructedLung(*free, RaisedSheet(*free, -0.02), zero).x);
}

// A vertex that is put back moves with the sheet along its normal: the rate of the distance is 0.
TEST(SheetObstacle, VelocitiesAreThoseOfThePositions) {
  const auto model = CompileText(DomeUnderLung("obstacle: 'sheet'"));
  Points rates = Points::Zero(3, model->rest.cols());
  rates.row(2).setConstant(0.1);
  constexpr double kStep = 1e-6;
  const LungPlaces now = ObstructedLung(*model, RaisedSheet(*model, 0.02), rates);
  const Points after = ObstructedLung(*model, RaisedSheet(*model, 0.02 + 0.1 * kStep), rates).x;
  const Points difference = (after - now.x) / kStep;
  int apart = 0;
  for (Eigen::Index i = 0; i < now.v.cols(); ++i) apart += (difference.col(i) - now.v.col(i)).norm() > 0.01 ? 1 : 0;
  EXPECT_LE(apart, now.v.cols() / 50) << "only where the nearest point passes from one triangle to the next";
}

TEST(SheetObstacle, ErrorsNameTheField) {
  const auto error = [](const std::string& skin) {
    return std::string(TryCompileText(DomeUnderLung(skin)).status().message());
  };
  EXPECT_THAT(error("obstacle: 'bone'"),
              testing::HasSubstr("motions[0].skin.obstacle: body \"bone\" must have ROLE_DEFORMABLE"));
  EXPECT_THAT(error("obstacle: 'no'"), testing::HasSubstr("motions[0].skin.obstacle"));
  EXPECT_THAT(error("obstacle: 'sheet' mode: SKIN_MODE_BAR"),
              testing::HasSubstr("motions[0].skin.obstacle: only SKIN_MODE_NEAREST_VERTICES"));
}

}  // namespace
}  // namespace phrenic
