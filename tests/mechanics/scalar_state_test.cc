// Generalised coordinates that are not vertices: a state carries them wherever it goes.
#include <gtest/gtest.h>

#include <bit>

#include "tests/scalar_motion.h"

namespace phrenic {
namespace {

TEST(ScalarState, IsEmptyWhereTheModelHasNone) {
  const State state = CompileText(kTriangle)->InitialState();
  EXPECT_EQ(state.scalars.q.size(), 0);
  EXPECT_EQ(state.scalars.v.size(), 0);
}

TEST(ScalarState, BuilderNumbersCoordinatesAndReportsThem) {
  ModelBuilder builder;
  EXPECT_EQ(builder.AddScalar("angle", "rad", 0.25), 0);
  EXPECT_EQ(builder.AddScalar("volume", "m^3", 3, 1), 1);
  ASSERT_EQ(builder.model.scalars.size(), 2u);
  EXPECT_EQ(builder.model.scalars[1].name, "volume");
  EXPECT_EQ(builder.model.scalars[1].unit, "m^3");
  ASSERT_EQ(builder.model.report.elements_size(), 2);
  EXPECT_EQ(builder.model.report.elements(0).family(), "coordinate");
  EXPECT_EQ(builder.model.report.elements(0).detail(), "starts at 0.25 rad");
}

TEST(ScalarState, InternalCoordinatesAreReportedTogether) {
  ModelBuilder builder;
  builder.AddScalar("angle", "rad", 0.25);
  EXPECT_EQ(builder.AddInternalScalars("rate", "1/s", 3), 1);
  ASSERT_EQ(builder.model.scalars.size(), 4u);
  EXPECT_FALSE(builder.model.scalars[0].internal);
  EXPECT_TRUE(builder.model.scalars[3].internal);
  EXPECT_EQ(builder.model.scalars[3].name, "rate-2");
  EXPECT_EQ(builder.model.scalars[3].initial, 0);
  ASSERT_EQ(builder.model.report.elements_size(), 2);
  EXPECT_EQ(builder.model.report.elements(1).count(), 3);
}

TEST(ScalarState, StartsAtItsInitialValuesAndWhereMotionsDriveIt) {
  const State state = CompileWithScalars(kTriangle)->InitialState();
  ASSERT_EQ(state.scalars.q.size(), 2);
  EXPECT_EQ(state.scalars.q[0], 0);
  EXPECT_EQ(state.scalars.v[0], 1);
  EXPECT_EQ(state.scalars.q[1], 0.5);
  EXPECT_EQ(state.scalars.v[1], -0.25);
}

TEST(ScalarState, ElementsReadIt) {
  const auto model = CompileWithScalars(kTriangle);
  const State state = model->InitialState();
  EXPECT_EQ(&MakeEvalContext(*model, model->parameters, state).scalars, &state.scalars);
}

TEST(ScalarState, StepsCarryItAndMotionsDriveIt) {
  const auto model = CompileWithScalars(kTriangle);
  for (const double tolerance : {0.0, 1e-3}) {  // 1e-3: steps in trial halves
    v1::Parameters parameters = model->parameters;
    parameters.set_step_tolerance(tolerance);
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(Step(*model, parameters, 0.01, state, work).ok());
    EXPECT_NEAR(state.scalars.q[0], std::sin(state.time), 1e-12) << tolerance;
    EXPECT_NEAR(state.scalars.v[0], std::cos(state.time), 1e-12) << tolerance;
    EXPECT_EQ(state.scalars.q[1], 0.5);
    EXPECT_EQ(state.scalars.v[1], -0.25);
  }
}

TEST(ScalarState, EveryBitOfItCountsInTheHash) {
  const State state = CompileWithScalars(kTriangle)->InitialState();
  const std::uint64_t hash = StateHash(state);
  for (Eigen::VectorXd ScalarState::*part : {&ScalarState::q, &ScalarState::v}) {
    for (Eigen::Index i = 0; i < 2; ++i) {
      State other = state;
      double& value = (other.scalars.*part)[i];
      value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1);
      EXPECT_NE(StateHash(other), hash);
    }
  }
}

TEST(ScalarState, WithoutItTheHashIsThatOfTheVertices) {
  State state;
  state.time = 0.5;
  state.phase = 0.125;
  state.x = Points::Constant(3, 2, 0.25);
  state.v = Points::Constant(3, 2, -1);
  EXPECT_EQ(StateHash(state), 0x13263307d3226c99u);  // of the version before states had scalars
}

TEST(ScalarState, EqualRunsHaveEqualHashes) {
  const auto model = CompileWithScalars(kTriangle);
  EXPECT_EQ(StateHash(RunTo(*model, 0.5, 0.01)), StateHash(RunTo(*model, 0.5, 0.01)));
}

}  // namespace
}  // namespace phrenic
