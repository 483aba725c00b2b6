// The step of every shipped scene keeps a margin of 5 % from the step at which its run leaves the run at a tenth of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "server/session/models.h"
#include "server/study/leaving.h"
#include "tests/study/run_on.h"

namespace phrenic::study {
namespace {

constexpr double kSeconds = 2, kMostCpu = 120;  // [s]
constexpr double kMargin = 0.95;
constexpr double kGrowth = 1e6;

std::vector<std::string> ShippedScenes() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(PHRENIC_SCENES_DIR))
    names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedStep : public testing::TestWithParam<std::string> {};

TEST_P(ShippedStep, KeepsAMarginOfFivePercent) {
  const std::string data = PHRENIC_SHARED_DIR "/data";
  const bool found = std::filesystem::is_directory(data);
  if (GetParam().starts_with("thorax-patient") && !found) GTEST_SKIP() << "there are no patient's surfaces at " << data;
  session::Models models(session::SceneCatalogue({PHRENIC_SCENES_DIR}), found ? data : "", 1);
  v1::SceneSource source;
  source.set_name(GetParam());
  if (GetParam() == "thorax-thesis") source.set_resolution_mm(16);
  const auto model = models.Get(source);
  ASSERT_TRUE(model.ok()) << model.status();
  const Subject subject{.model = *model, .parameters = (*model)->parameters};
  const double dt = subject.parameters.time_step();
  const auto tenth = RunShortSteps(subject, (*model)->InitialState(), kSeconds, dt / 10, kMostCpu, kNeverCancel);
  ASSERT_TRUE(tenth.ok()) << tenth.status();
  ASSERT_EQ(tenth->problem, "");
  const auto trial = TryStep(subject, *tenth, dt / kMargin, kGrowth, kMostCpu, kNeverCancel);
  ASSERT_TRUE(trial.ok()) << trial.status();
  EXPECT_EQ(*trial, Trial::kStays) << "at " << dt / kMargin << " s; the scene's step is " << dt << " s";
}

INSTANTIATE_TEST_SUITE_P(All, ShippedStep, testing::ValuesIn(ShippedScenes()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace phrenic::study
