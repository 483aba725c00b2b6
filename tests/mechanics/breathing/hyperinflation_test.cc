// Air that stays in the lungs: what action lines and ribs make of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

constexpr double kMuscle = 4, kAir = 2;

std::shared_ptr<const Model> WithAir(const std::string& air) {
  return CompileText(
      Triangle("breath { waveform: WAVEFORM_RAISED_COSINE } forces { action_line { bodies: 'sheet' "
               "origin {} direction { z: -1 } radius: 3 force: 4 " +
               air + " } }"));
}

// Of all that the line pulls, upwards [N].
double Upwards(const Model& model, const v1::Parameters& parameters, double phase) {
  const State state = model.InitialState();
  Points force = Points::Zero(3, state.x.cols());
  model.forces.back()->AddForce(MakeEvalContext(model, parameters, state, 0, phase), force);
  return force.row(2).sum();
}

TEST(Hyperinflation, HoldsTheDomesLowWhateverTheMuscleDoes) {
  const auto model = WithAir("air_load: 2");
  v1::Parameters parameters = model->parameters;
  parameters.set_hyperinflation(1.5);
  EXPECT_NEAR(Upwards(*model, parameters, 0), -1.5 * kAir, 1e-12);
  EXPECT_NEAR(Upwards(*model, parameters, 0.5), -1.5 * kAir - kMuscle, 1e-12);
  parameters.set_apply_muscles(false);
  EXPECT_NEAR(Upwards(*model, parameters, 0.5), -1.5 * kAir, 1e-12);
}

TEST(Hyperinflation, OfNothingIsTheMotionWithoutItToTheLastBit) {
  const auto with = WithAir("air_load: 2"), without = WithAir("");
  State a = with->InitialState(), b = without->InitialState();
  Workspace work_a = with->MakeWorkspace(), work_b = without->MakeWorkspace();
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(Step(*with, with->parameters, 1e-3, a, work_a).ok());
    ASSERT_TRUE(Step(*without, without->parameters, 1e-3, b, work_b).ok());
  }
  EXPECT_EQ(StateHash(a), StateHash(b));
}

TEST(Hyperinflation, IsIdleWhereNothingHoldsAir) {
  const auto idle = WithAir("")->report.idle_parameters();
  EXPECT_THAT(idle, testing::Contains("hyperinflation"));
  const auto active = WithAir("air_load: 2")->report.idle_parameters();
  EXPECT_THAT(active, testing::Not(testing::Contains("hyperinflation")));
}

}  // namespace
}  // namespace phrenic
