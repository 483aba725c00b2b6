// The tower of tensegrity prisms sways on its shaken base and stands because of its cables: with slack cables it falls.
#include <gtest/gtest.h>

#include <algorithm>

#include "server/mechanics/constraint_residual.h"
#include "tests/compile_text.h"
#include "tests/thesis/shipped.h"

namespace phrenic {
namespace {

struct Sway {
  double lowest = 10, left = -10, right = 10;  // extreme positions of the top [m]
  double residual = 0;                         // largest constraint residual [m]
};

Sway Shake(double elasticity) {
  const auto model = CompileText(ShippedScene("tensegrity-prism"));
  v1::Parameters parameters = model->parameters;
  parameters.set_elasticity(elasticity);
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  Sway sway;
  const int top = model->probes.front().vertex;
  while (state.time < 20) {
    EXPECT_TRUE(Step(*model, parameters, parameters.time_step(), state, work).ok());
    sway.lowest = std::min(sway.lowest, state.x(2, top));
    sway.left = std::max(sway.left, state.x(0, top));
    sway.right = std::min(sway.right, state.x(0, top));
    sway.residual = std::max(sway.residual, LargestResidual(*model, state).metres);
  }
  return sway;
}

TEST(Tower, StandsOnItsCablesAndSways) {
  const Sway taut = Shake(1), slack = Shake(0.02);
  EXPECT_GT(taut.lowest, 1) << "four fifths of its height";
  EXPECT_GT(taut.left - taut.right, 0.2) << "the tower sways visibly";
  EXPECT_LT(taut.residual, 1e-9);
  EXPECT_LT(slack.lowest, 0.6);
}

}  // namespace
}  // namespace phrenic
