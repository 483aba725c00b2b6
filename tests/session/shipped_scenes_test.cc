// Every shipped scene compiles, moves, stays within its bounds, and gives the same state when it is repeated.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "server/mechanics/step/step.h"
#include "server/session/models.h"

namespace phrenic::session {
namespace {

const std::string kScenes = PHRENIC_SOURCE_DIR "/server/scenes";
const std::string kData = PHRENIC_SHARED_DIR "/data";

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(kScenes)) names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, RunsAndRepeats) {
  const bool data = std::filesystem::is_directory(kData);
  if (GetParam().starts_with("thorax-patient") && !data) GTEST_SKIP() << "there are no patient's surfaces at " << kData;
  Models models(SceneCatalogue({kScenes}), data ? kData : "", 1);
  v1::SceneSource source;
  source.set_name(GetParam());
  if (GetParam() == "thorax-thesis") source.set_resolution_mm(16);
  const auto model = models.Get(source);
  ASSERT_TRUE(model.ok()) << model.status();
  const v1::Parameters& parameters = (*model)->parameters;
  std::uint64_t first = 0;
  for (int run = 0; run < 2; ++run) {
    State state = (*model)->InitialState();
    Workspace work = (*model)->MakeWorkspace();
    for (int i = 0; i < 12; ++i) {
      const absl::Status stepped = Step(**model, parameters, parameters.time_step(), state, work);
      ASSERT_TRUE(stepped.ok()) << stepped << " at step " << i;
    }
    EXPECT_GT((state.x - (*model)->rest).cwiseAbs().maxCoeff(), 0);
    if (run == 0) first = StateHash(state);
    EXPECT_EQ(StateHash(state), first);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(SceneNames()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class MixedScene : public testing::TestWithParam<std::tuple<v1::Integrator, double>> {};

// The tendon is compressed while it is pulled down, where the stiffness is indefinite. Newton's method, with the
// positive semi-definite part of the stiffness, converges nevertheless.
TEST_P(MixedScene, LongStiffStepsConverge) {
  Models models(SceneCatalogue({kScenes}), "", 1);
  v1::SceneSource source;
  source.set_name("mixed-methods");
  const auto model = models.Get(source);
  ASSERT_TRUE(model.ok()) << model.status();
  v1::Parameters parameters = (*model)->parameters;
  parameters.set_integrator(std::get<0>(GetParam()));
  parameters.set_elasticity(std::get<1>(GetParam()));
  for (const double dt : {0.025, 0.1}) {
    State state = (*model)->InitialState();
    Workspace work = (*model)->MakeWorkspace();
    while (state.time < 0.3) {
      const absl::Status stepped = Step(**model, parameters, dt, state, work);
      ASSERT_TRUE(stepped.ok()) << stepped << " at " << state.time << " s by " << dt << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MixedScene,
                         testing::Combine(testing::Values(v1::INTEGRATOR_BDF2, v1::INTEGRATOR_TR_BDF2),
                                          testing::Values(1, 100)));

}  // namespace
}  // namespace phrenic::session
