// Cables pull only; limits hold only at their ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mechanics/constraint_residual.h"
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
    model->forces.front()->AddForce(MakeEvalContext(*model, model->parameters, state), f);
    return f(0, 0);
  };
  EXPECT_EQ(pull(0.5), 0);
  EXPECT_EQ(model->forces.front()->Energy(MakeEvalContext(*model, model->parameters, state)), 0);
  EXPECT_NEAR(pull(1.25), 2.5, 1e-15);
}

// A cable that is slack at rest may get taut: the largest stable step is that of the taut one.
TEST(Cable, CountsForTheStableStepAlsoWhenSlack) {
  const auto with = [](const char* ratio) {
    return CompileText(std::string(kPair) + "forces { cables { body: 'pair' stiffness: 10 rest_length_ratio: " + ratio +
                       " } }");
  };
  const double slack = with("1.5")->report.stable_step().omega_max(),
               taut = with("0.5")->report.stable_step().omega_max();
  EXPECT_NEAR(slack, std::sqrt(10), 1e-6);
  EXPECT_NEAR(slack, taut, 1e-6);
}

// Thrown outwards slack, the mass flies freely until the cable is taut and then falls back or stays: an inelastic jerk.
TEST(Limit, LetsFlyUntilItIsReached) {
  const auto model = CompileText(std::string(kPair) +
                                 "constraints { length_limits { body: 'pair' at_most_ratio: 2 at_least_ratio: 0.5 } }");
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
  EXPECT_NEAR(state.x(0, 1), 0.5, 1e-6) << "nothing holds it there but that it was stopped";
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-9);
}

TEST(Limits, ThatLimitNothingAreAnErrorWithARemedy) {
  const auto model = TryCompileText(std::string(kPair) + "constraints { length_limits { body: 'pair' } }");
  EXPECT_EQ(model.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(model.status().message().find("constraints[0].length_limits: limits nothing: set at_most_ratio"),
            std::string::npos)
      << model.status();
}

// A net held at two corners, of threads that hardly stretch: some are taut, some are slack, none is too long.
TEST(Limits, LetGoWhatWouldHaveToPush) {
  const auto model = CompileText(
      "name: 'net' bodies { name: 'net' role: ROLE_DEFORMABLE mass: 30 fixed_vertices: [0, 5] grid { columns: 6 rows: "
      "5 "
      "u { x: 0.1 } v { y: 0.1 } } } forces { gravity { bodies: 'net' acceleration { z: -9.81 } } } forces { friction "
      "{ "
      "bodies: 'net' rate: 0.5 } } constraints { length_limits { body: 'net' at_most_ratio: 1.05 } }");
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  double longest = 0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(Step(*model, model->parameters, 1e-3, state, work).ok());
    longest = std::max(longest, LargestResidual(*model, state).metres);
  }
  EXPECT_LT(longest, 1e-9);
  EXPECT_LT(state.x.row(2).minCoeff(), -0.3) << "it hangs";
  const double upper = (state.x.col(2) - state.x.col(3)).norm();
  EXPECT_LT((state.x.col(26) - state.x.col(27)).norm(), upper) << "the lower border is slack";
}

// A weight on a string of ten pieces that do not stretch hangs at the length of the string.
TEST(Limits, MakeAStringOfManyPieces) {
  std::string text =
      "name: 'string' bodies { name: 'string' role: ROLE_DEFORMABLE mass: 11 fixed_vertices: 0 polyhedron {";
  for (int i = 0; i <= 10; ++i) text += " vertices { x: " + std::to_string(0.1 * i) + " }";
  for (int i = 0; i < 10; ++i) text += " edges { a: " + std::to_string(i) + " b: " + std::to_string(i + 1) + " }";
  const auto model = CompileText(text +
                                 " } } forces { gravity { bodies: 'string' acceleration { z: -9.81 } } } forces { "
                                 "friction { bodies: 'string' rate: 3 } } constraints { length_limits { body: 'string' "
                                 "at_most_ratio: 1 } }");
  const State state = RunTo(*model, 20, 2e-3);
  EXPECT_NEAR(state.x(2, 10), -1, 1e-6);
  EXPECT_LT(LargestResidual(*model, state).metres, 1e-9);
}

// A string of ten pieces that do not stretch, held at one end, with links restored in two sweeps a step. Returns how
// far below its length its end hangs [m].
double SagOfSweptString(double dt) {
  std::string text =
      "name: 'string' bodies { name: 'string' role: ROLE_DEFORMABLE mass: 11 fixed_vertices: 0 polyhedron {";
  for (int i = 0; i <= 10; ++i) absl::StrAppend(&text, " vertices { x: ", 0.1 * i, " }");
  for (int i = 0; i < 10; ++i) absl::StrAppend(&text, " edges { a: ", i, " b: ", i + 1, " }");
  const auto model = CompileText(text +
                                 " } } forces { gravity { bodies: 'string' acceleration { z: -9.81 } } } forces { "
                                 "friction { bodies: 'string' rate: 6 } } constraints { length_limits { body: 'string' "
                                 "at_most_ratio: 1 sweeps: 2 } }");
  const State state = RunTo(*model, 8, dt);
  EXPECT_NEAR(state.x(0, 10), 0, 1e-3) << "it hangs straight down";
  EXPECT_GT(LargestResidual(*model, state).metres, 0) << "sweeps leave an error";
  return -1 - state.x(2, 10);
}

TEST(SweptLimits, MissTheirLengthByTheSquareOfTheStep) {
  const double coarse = SagOfSweptString(2e-3), fine = SagOfSweptString(1e-3);
  EXPECT_GT(coarse, 0);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
}

TEST(SweptLimits, DoNotHoldWhatIsPushedTogether) {
  const auto model = CompileText(
      "name: 'pair' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 polyhedron { vertices { } vertices { x: 1 } "
      "edges { a: 0 b: 1 } } } constraints { length_limits { body: 'pair' at_most_ratio: 1 sweeps: 3 } }");
  State state = model->InitialState();
  state.v(0, 0) = 0.5;
  Workspace work = model->MakeWorkspace();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Step(*model, model->parameters, 1e-2, state, work).ok());
  EXPECT_NEAR(state.x(0, 0), 0.5, 1e-12);
  EXPECT_EQ(state.x(0, 1), 1);
}

TEST(SweptLimits, AreRefusedWithTheThesisProjection) {
  const auto refused = TryCompileText(
      "name: 'pair' bodies { name: 'pair' role: ROLE_DEFORMABLE mass: 2 polyhedron { vertices { } vertices { x: 1 } "
      "} } constraints { rigid_links { body: 'pair' list { links { a: 0 b: 1 } } projection: PROJECTION_THESIS sweeps: "
      "2 } }");
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(refused.status().message().find("rigid_links.sweeps"), std::string::npos) << refused.status();
}

}  // namespace
}  // namespace phrenic
