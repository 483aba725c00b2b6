// The outputs of a breath of a thorax: those of physiology, and statistics of the scene's measures in the same breath.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/mechanics/compile/presets.h"
#include "server/physiology/measures.h"
#include "server/session/models.h"
#include "server/study/uncertainty/outputs.h"

namespace phrenic::study {
namespace {

using Wanted = google::protobuf::RepeatedPtrField<v1::StudiedOutput>;

void Add(const std::string& measure, v1::Statistic statistic, Wanted& wanted) {
  wanted.Add()->set_measure(measure);
  wanted.rbegin()->set_statistic(statistic);
}

class BreathOutputs : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    session::Models models(session::SceneCatalogue({PHRENIC_SCENES_DIR}), "", 1);
    v1::SceneSource source;
    source.set_name("thorax");
    source.set_resolution_mm(10);
    model_ = *models.Get(source);
  }
  static void TearDownTestSuite() { model_.reset(); }

  static v1::Parameters PresetOf(const std::string& name) {
    v1::Parameters parameters = model_->parameters;
    parameters.MergeFrom(*FindPreset(model_->scene, name));
    return parameters;
  }
  static std::vector<double> ValuesOf(const Wanted& wanted, const std::string& preset) {
    const auto outputs = Outputs::Make(*model_, wanted, std::nullopt, false);
    EXPECT_TRUE(outputs.ok()) << outputs.status();
    const auto run = (*outputs)->Run(PresetOf(preset), [] { return false; });
    EXPECT_TRUE(run.ok()) << run.status();
    EXPECT_EQ(run->problem, "");
    return run->values;
  }

  static std::shared_ptr<const Model> model_;
};
std::shared_ptr<const Model> BreathOutputs::model_;

TEST_F(BreathOutputs, AreThoseOfPhysiologyAndOfTheScenesMeasuresAlike) {
  Wanted wanted;
  Add("tidal-volume", v1::STATISTIC_UNSPECIFIED, wanted);
  Add("lung volume", v1::STATISTIC_AMPLITUDE, wanted);
  Add("lung volume", v1::STATISTIC_MINIMUM, wanted);
  Add("lung volume", v1::STATISTIC_MEAN, wanted);
  const std::vector<double> values = ValuesOf(wanted, "quiet");
  const auto subject = physiology::Subject::Of(*model_);
  const auto recording = physiology::Record(
      **subject, "quiet", PresetOf("quiet"), [](double) { return true; }, physiology::FlawSearch::kNever);
  ASSERT_TRUE(recording.ok());
  EXPECT_EQ(values[0], physiology::TidalVolume(*recording, *recording));
  EXPECT_NEAR(values[1], 1e-3 * values[0], 1e-9);
  EXPECT_GT(values[3], values[2]);
  EXPECT_LT(values[3], values[2] + values[1]);
}

TEST_F(BreathOutputs, TellAParalysedDomeFromAHealthyOne) {
  Wanted wanted;
  Add("right-dome", v1::STATISTIC_UNSPECIFIED, wanted);
  Add("right-dome-rise", v1::STATISTIC_UNSPECIFIED, wanted);
  Add("left-dome", v1::STATISTIC_UNSPECIFIED, wanted);
  const std::vector<double> health = ValuesOf(wanted, "quiet"), palsy = ValuesOf(wanted, "palsy-right");
  EXPECT_GT(health[0], health[1]);
  EXPECT_GT(palsy[1], palsy[0]);
  EXPECT_GT(palsy[2], 5);
}

TEST_F(BreathOutputs, NeedABreath) {
  Wanted wanted;
  Add("tidal-volume", v1::STATISTIC_UNSPECIFIED, wanted);
  const auto outputs = Outputs::Make(*model_, wanted, 2, false);
  EXPECT_THAT(std::string(outputs.status().message()), testing::HasSubstr("there is no measure \"tidal-volume\""));
  Add("tidal-volume", v1::STATISTIC_MEAN, wanted);
  EXPECT_THAT(std::string(Outputs::Make(*model_, wanted, std::nullopt, false).status().message()),
              testing::HasSubstr("outputs[1].statistic"));
}

TEST_F(BreathOutputs, OfADiaphragmAreItsBreathsMeasuresByDefault) {
  const auto outputs = Outputs::Make(*model_, {}, std::nullopt, false);
  ASSERT_TRUE(outputs.ok()) << outputs.status();
  EXPECT_EQ((*outputs)->outputs().size(), calibrate::Targets().size());
}

}  // namespace
}  // namespace phrenic::study
