// Cables pull only; limits hold only at their ends.
#include <gtest/gtest.h>

#include "server/mechanics/residual.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

const char kPair[] =
    "name: 'pair' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 polyhedron { vertices {} "
    "vertices { x: 1 } edges { a: 0 b: 1 } } } ";

TEST(Cable, IsNothingWhenSlackAndASpringWhenTaut) {
  const auto model = CompileText(std::string(kPair) + "forces { cables { body: 'pair' stiffness: 10 } }");
  State state = model->InitialState();
  const auto pull = [&](double length) {
    state.x(0, 1) = length;
    Points f = Points::Zero(3, 2);
    model->forces.front()->AddForce(MakeInstant(*model, model->parameters, state), f);
    return f(0, 0);
  };
  EXPECT_EQ(pull(0.5), 0);
  EXPECT_EQ(model->forces.front()->Energy(MakeInstant(*model, model->parameters, state)), 0);
  EXPECT_NEAR(pull(1.25), 2.5, 1e-15);
}

// Thrown outwards slack, the mass flies freely until the cable is taut and then falls back or stays: an inelastic jerk.
TEST(Limit, LetsFlyUntilItIsReached) {
  const auto model =
      CompileText(std::string(kPair) + "constraints { limits { body: 'pair' at_most_ratio: 2 at_least_ratio: 0.5 } }");
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  const auto fly = [&](double velocity, int steps) {
    state.v.col(1) = Eigen::Vector3d(velocity, 0, 0);
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
  };
  fly(1, 900);
  EXPECT_NEAR(state.x(0, 1), 1.9, 1e-12);
  fly(1, 900);
  EXPECT_NEAR(state.x(0, 1), 2, 1e-9);
  EXPECT_NEAR(state.v(0, 1), 0, 1e-9);
  fly(-2, 2000);
  EXPECT_NEAR(state.x(0, 1), 0.5, 1e-9);
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-9);
}

TEST(Limits, ThatLimitNothingAreAnErrorWithARemedy) {
  const auto model = TryCompileText(std::string(kPair) + "constraints { limits { body: 'pair' } }");
  EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(model.status().message().find("constraints[0].limits: limits nothing: set at_most_ratio"),
            std::string::npos)
      << model.status();
}

// A weight on a string of ten pieces that do not stretch hangs at the length of the string.
TEST(Limits, MakeAStringOfManyPieces) {
  std::string text =
      "name: 'string' bodies { name: 'string' role: ROLE_DEFORMABLE mass: 11 fixed_vertices: 0 polyhedron {";
  for (int i = 0; i <= 10; ++i) text += " vertices { x: " + std::to_string(0.1 * i) + " }";
  for (int i = 0; i < 10; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  const auto model = CompileText(text +
                                 " } } forces { gravity { bodies: 'string' acceleration { z: -9.81 } } } forces { "
                                 "friction { bodies: 'string' rate: 3 } } constraints { limits { body: 'string' "
                                 "at_most_ratio: 1 } }");
  const State state = RunTo(*model, 20, 2e-3);
  EXPECT_NEAR(state.x(2, 10), -1, 1e-6);
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-6);
}

}  // namespace
}  // namespace phrenic
