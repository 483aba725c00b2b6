// What a run that goes far is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/stability/diagnosis.h"
#include "tests/compile_text.h"

namespace phrenic {
namespace {

#define BALL                                                                                                        \
  "name: 'fall' bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 2 grid { columns: 3 rows: 3 u { x: 0.1 } v { y: " \
  "0.1 } } } forces { gravity { bodies: 'ball' acceleration { z: -9.81 } } } "

// Under every integrator: 20 s are 1,962 m, or 7,000 of its sizes.
TEST(FreeFall, IsNoDivergence) {
  for (const char* integrator : {"SEMI_IMPLICIT_EULER", "VELOCITY_VERLET", "LINEAR_IMPLICIT_EULER", "BDF2"}) {
    const auto model = CompileText(std::string(BALL "forces { springs { bodies: 'ball' stiffness: 300 } } parameters { "
                                                    "integrator: INTEGRATOR_") +
                                   integrator + " }");
    ASSERT_NE(model, nullptr);
    const State state = RunTo(*model, 20, 1e-3);
    EXPECT_NEAR(state.x(2, 4), -0.5 * 9.81 * 400, 0.2) << integrator;
  }
}

// Steps until one fails; its diagnosis.
v1::Divergence Diverge(const Model& model, const v1::Parameters& parameters, int most) {
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  for (int i = 0; i < most; ++i) {
    const State before = state;
    const absl::Status stepped = Step(model, parameters, parameters.time_step(), state, work);
    if (!stepped.ok()) return Diagnose(model, parameters, stepped, before, state);
  }
  ADD_FAILURE() << "did not diverge";
  return {};
}

TEST(FreeFall, EndsWhereItsNumbersDoAndIsToldThatNothingHoldsIt) {
  const auto model =
      CompileText(BALL "forces { springs { bodies: 'ball' stiffness: 300 } } parameters { time_step: 0.01 }");
  const v1::Divergence why = Diverge(*model, model->parameters, 100'000);
  EXPECT_THAT(why.remedy(), testing::HasSubstr("nothing holds this part of the body"));
  EXPECT_THAT(why.remedy(), testing::HasSubstr("gravity"));
  EXPECT_THAT(why.remedy(), testing::Not(testing::HasSubstr("breath_force")));
}

// A body without a held vertex still diverges within a few steps above its stable step, and the step is named.
TEST(LooseBody, ThatVibratesTooFastForItsStepDivergesForThat) {
  const auto model = CompileText(BALL "forces { springs { bodies: 'ball' stiffness: 300 rest_length_ratio: 0.9 } }");
  v1::Parameters parameters = model->parameters;
  parameters.set_time_step(1.5 * model->report.stable_step().seconds());
  EXPECT_THAT(Diverge(*model, parameters, 2'000).remedy(), testing::HasSubstr("above the largest stable step"));
}

// Stretched by its weight, not by a muscle.
TEST(HeavySheet, IsToldOfItsWeight) {
  const auto model = CompileText(
      "name: 'heavy' bodies { name: 'ball' role: ROLE_DEFORMABLE mass: 2 fixed_vertices: 0 grid { columns: 3 rows: 3 u "
      "{ x: 0.1 } v { y: 0.1 } } } forces { gravity { bodies: 'ball' acceleration { z: -9.81 } } } forces { springs { "
      "bodies: 'ball' stiffness: 0.5 } } parameters { time_step: 0.001 }");
  EXPECT_THAT(Diverge(*model, model->parameters, 100'000).remedy(), testing::HasSubstr("lower its acceleration"));
}

}  // namespace
}  // namespace phrenic
