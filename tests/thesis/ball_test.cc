// The ball of the shipped scene "contact" bounces on its sheet without penetrating it.
#include <gtest/gtest.h>

#include <algorithm>

#include "server/mesh/triangle_tree.h"
#include "tests/compile_text.h"
#include "tests/thesis/shipped.h"

namespace phrenic {
namespace {

// Returns the largest penetration of vertices of one body behind the other's triangles [m].
double Depth(const ConstPoints& x, const ConstPoints& surface, const TriangleTree& tree) {
  TriangleTree::Boxes boxes;
  tree.Fit(surface, boxes);
  double deepest = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const SurfacePoint nearest = tree.Nearest(surface, boxes, x.col(i), 0.3);
    if (nearest.triangle >= 0 && nearest.facing > 0 && !nearest.on_boundary) {
      deepest = std::max(deepest, nearest.offset.norm());
    }
  }
  return deepest;
}

TEST(BallOnASheet, StaysOnItAndBounces) {
  const auto model = CompileText(ShippedScene("contact"));
  const BodyModel &sheet = model->bodies[0], &ball = model->bodies[1];
  const TriangleTree sheet_tree(sheet.mesh.vertices, sheet.mesh.triangles);
  const TriangleTree ball_tree(ball.mesh.vertices, ball.mesh.triangles);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  const auto of = [&state](const BodyModel& body) {
    return state.x.middleCols(body.first_vertex, body.mesh.vertices.cols());
  };
  double deepest = 0, lowest = 10, highest = -10;
  for (int i = 0; state.time < 15; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, model->parameters.time_step(), state, work).ok());
    if (i % 20 > 0) continue;
    deepest = std::max({deepest, Depth(of(ball), of(sheet), sheet_tree), Depth(of(sheet), of(ball), ball_tree)});
    const double height = of(ball).row(2).mean();
    lowest = std::min(lowest, height);
    if (state.time > 5) highest = std::max(highest, height);
  }
  RecordProperty("deepest_um", static_cast<int>(1e6 * deepest));
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 0.01) << "the contact depth of the scene";
  EXPECT_GT(lowest, -0.5) << "the ball does not fall through the sheet";
  EXPECT_GT(highest, lowest + 0.3) << "the ball bounces visibly";
}

}  // namespace
}  // namespace phrenic
