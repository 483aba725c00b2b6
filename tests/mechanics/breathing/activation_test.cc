// A muscle that is active in part: what its action line comes to.
#include <gtest/gtest.h>

#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

constexpr double kForce = 4, kLungLoad = 3;

// The triangle, drawn down by a muscle of this side against the lungs.
std::shared_ptr<const Model> WithMuscle(const std::string& side) {
  return CompileText(
      Triangle("breath { waveform: WAVEFORM_RAISED_COSINE } forces { action_line { bodies: 'sheet' "
               "origin {} direction { z: -1 } radius: 3 force: 4 lung_load: 3 " +
               side + " } }"));
}

// Of all that the line pulls, upwards, at the peak of a breath [N].
double Upwards(const Model& model, const v1::Parameters& parameters) {
  const State state = model.InitialState();
  Points force = Points::Zero(3, state.x.cols());
  model.forces.back()->AddForce(MakeEvalContext(model, parameters, state, 0, 0.5), force);
  return force.row(2).sum();
}

TEST(Activation, LeavesOfAParalysedMuscleWhatTheLungsPull) {
  const auto model = WithMuscle("side: SIDE_RIGHT");
  v1::Parameters parameters = model->parameters;
  EXPECT_DOUBLE_EQ(Upwards(*model, parameters), -kForce);
  parameters.set_right_activation(0);
  EXPECT_NEAR(Upwards(*model, parameters), kLungLoad, 1e-12);
}

TEST(Activation, IsLinearAndVanishesWhereMuscleAndLungsAreEven) {
  const auto model = WithMuscle("side: SIDE_LEFT");
  v1::Parameters parameters = model->parameters;
  parameters.set_left_activation(0.5);
  EXPECT_NEAR(Upwards(*model, parameters), (kLungLoad - kForce) / 2, 1e-12);
  parameters.set_left_activation(kLungLoad / (kForce + kLungLoad));
  EXPECT_NEAR(Upwards(*model, parameters), 0, 1e-12);
}

TEST(Activation, OfOneSideDoesNothingToTheOtherOrToAMuscleOfNone) {
  for (const char* side : {"side: SIDE_LEFT", ""}) {
    const auto model = WithMuscle(side);
    v1::Parameters parameters = model->parameters;
    parameters.set_right_activation(0);
    EXPECT_DOUBLE_EQ(Upwards(*model, parameters), -kForce) << side;
  }
}

TEST(Activation, IsIdleWhereNoMuscleHasItsSide) {
  const auto model = WithMuscle("side: SIDE_LEFT");
  const auto& idle = model->report.idle_parameters();
  EXPECT_EQ(std::count(idle.begin(), idle.end(), "left_activation"), 0);
  EXPECT_EQ(std::count(idle.begin(), idle.end(), "right_activation"), 1);
}

}  // namespace
}  // namespace phrenic
