// The shipped scene "pressure-lungs" breathes with physiological volumes, flows and pressures.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "tests/compile_text.h"
#include "tests/thesis/shipped.h"

namespace phrenic {
namespace {

using Values = std::map<std::string, double>;

Values Read(const Model& model, const State& state) {
  Values values;
  for (const auto& measure : model.measures) {
    values[measure->name()] = measure->Value(MakeEvalContext(model, model.parameters, state));
  }
  return values;
}

TEST(PressureLungs, HavePhysiologicalVolumesAndPressures) {
  const auto model = CompileText(ShippedScene("pressure-lungs"));
  State state = model->InitialState();
  Workspace work = model->MakeWorkspace();
  const double dt = model->parameters.time_step(), length = model->parameters.breath_length();
  const auto advance = [&](double until) {
    while (state.time < until - dt / 2) ASSERT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
  };
  const Values rest = Read(*model, state);
  EXPECT_NEAR(rest.at("lung volume"), 0.0025, 1e-12);
  EXPECT_NEAR(rest.at("pleural pressure"), -500, 1e-9);
  advance(length / 4);
  const Values inwards = Read(*model, state);
  EXPECT_GT(inwards.at("flow"), 1e-4) << "air flows in";
  EXPECT_LT(inwards.at("alveolar pressure"), 0);
  advance(length / 2);
  const Values full = Read(*model, state);
  const double tidal = full.at("lung volume") - rest.at("lung volume");
  EXPECT_GT(tidal, 3e-4);
  EXPECT_LT(tidal, 8e-4);
  EXPECT_NEAR(full.at("pleural pressure"), -500 + full.at("alveolar pressure") - tidal / 2e-6, 1e-6);
  EXPECT_NEAR(full.at("abdominal pressure"), tidal / 2e-6, 1e-6) << "the abdomen loses the volume that the lungs gain";
  EXPECT_LT(full.at("dome height"), rest.at("dome height") - 0.01);
  EXPECT_NEAR(full.at("ventilator pressure"), 400, 4);
  EXPECT_GT(full.at("ventilated volume"), 1e-4);
  advance(3 * length / 4);
  EXPECT_LT(Read(*model, state).at("flow"), -1e-4) << "air flows out";
  advance(length);
  EXPECT_NEAR(Read(*model, state).at("lung volume"), rest.at("lung volume"), 0.15 * tidal);
}

// Airway resistance is integrated implicitly: a higher resistance does not shorten the step, and it reduces the inhaled
// volume.
TEST(PressureLungs, NarrowAirwaysShortenNoStep) {
  const std::string open = "resistance: 1.5e5", scene = ShippedScene("pressure-lungs");
  ASSERT_NE(scene.find(open), std::string::npos);
  double last = 1;
  for (const char* resistance : {"1.5e5", "1.5e6", "1.5e9"}) {
    SCOPED_TRACE(resistance);
    const auto model = CompileText(absl::StrReplaceAll(scene, {{open, absl::StrCat("resistance: ", resistance)}}));
    ASSERT_NE(model, nullptr);
    const double dt = model->parameters.time_step();
    EXPECT_GT(dt, 2e-3);
    State state = model->InitialState();
    Workspace work = model->MakeWorkspace();
    while (state.time < 2) ASSERT_TRUE(Step(*model, model->parameters, dt, state, work).ok());
    const double taken = Read(*model, state).at("lung volume") - 0.0025;
    EXPECT_GT(taken, 0);
    EXPECT_LT(taken, last);
    last = taken;
  }
  EXPECT_LT(last, 1e-6);
}

}  // namespace
}  // namespace phrenic
