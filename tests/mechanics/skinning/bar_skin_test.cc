// A bar between two bones turns with them without bending.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/skinning/body_points.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

// Two deformable balls, whose vertices stand in for bones that move, and a rod between them.
std::string RodText(const std::string& drivers) {
  return "name: 'rod' bodies { name: 'near' role: ROLE_DEFORMABLE ellipsoid { centre { x: -0.01 } radii { x: 0.01 y: "
         "0.01 z: 0.01 } divisions: 3 } } bodies { name: 'far' role: ROLE_DEFORMABLE ellipsoid { centre { x: 0.15 } "
         "radii { x: 0.01 y: 0.01 z: 0.01 } divisions: 3 } } bodies { name: 'bone' role: ROLE_AT_REST ellipsoid { "
         "centre { x: 0.15 } radii { x: 0.01 y: 0.01 z: 0.01 } divisions: 3 } } bodies { name: 'rod' role: ROLE_SEEN "
         "ellipsoid { centre { x: 0.07 } radii { x: 0.07 y: 0.008 z: 0.008 } divisions: 12 } } motions { skin { "
         "bodies: 'rod' " +
         drivers + " mode: SKIN_MODE_BAR } }";
}

// Returns the displacements of the rod's vertices if the vertices of each ball are moved by these.
Points RodMovedBy(const Model& model, const Eigen::Vector3d& near, const Eigen::Vector3d& far) {
  State state = model.InitialState();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) state.x.col(i) += model.rest(0, i) < 0.05 ? near : far;
  Points out(3, model.bodies.back().mesh.vertices.cols());
  PlaceBody(model, state, static_cast<int>(model.bodies.size()) - 1, out);
  return out - model.bodies.back().mesh.vertices;
}

TEST(BarSkin, FollowsDriversThatMoveAlike) {
  const auto model = CompileText(RodText("drivers: ['near', 'far']"));
  const Eigen::Vector3d by(0.01, -0.02, 0.03);
  const Points moved = RodMovedBy(*model, by, by);
  EXPECT_LT((moved.colwise() - by).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(BarSkin, TurnsWithoutBendingIfOneDriverMoves) {
  const auto model = CompileText(RodText("drivers: ['near', 'far']"));
  const Points moved = RodMovedBy(*model, {0, 0, 0.02}, {0, 0, 0});
  const Points& rest = model->bodies.back().mesh.vertices;
  for (Eigen::Index i = 0; i < rest.cols(); ++i) {
    EXPECT_NEAR(moved(2, i), 0.02 * (1 - rest(0, i) / 0.14), 1e-3) << "linear along the rod";
  }
}

TEST(BarSkin, ABoneAtRestHoldsItsEnd) {
  const auto model = CompileText(RodText("drivers: ['near', 'bone']"));
  const Points moved = RodMovedBy(*model, {0, 0, 0.02}, {0, 0, 0});
  Eigen::Index held = 0, carried = 0;
  model->bodies.back().mesh.vertices.row(0).maxCoeff(&held);
  model->bodies.back().mesh.vertices.row(0).minCoeff(&carried);
  EXPECT_NEAR(moved(2, held), 0, 1e-3);
  EXPECT_NEAR(moved(2, carried), 0.02, 1e-3);
}

TEST(BarSkin, NeedsTwoDrivers) {
  const auto model = Compile(*schema::ParseScene("rod.textproto", RodText("drivers: 'near'")), {});
  ASSERT_FALSE(model.ok());
  EXPECT_THAT(model.status().message(), testing::HasSubstr("motions[0].skin.drivers: SKIN_MODE_BAR is between two"));
}

}  // namespace
}  // namespace phrenic
