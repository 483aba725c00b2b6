// What a calibration reads and writes as text.
#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>

#include "server/calibrate/preset_text.h"
#include "server/calibrate/varied.h"

namespace phrenic::calibrate {
namespace {

using ::testing::HasSubstr;

std::string Refusal(const std::string& text) { return std::string(ReadVaried(text).status().message()); }

TEST(Varied, HasTheFieldsRangeOrTheGivenOne) {
  const auto whole = ReadVaried("intercostal_activation");
  ASSERT_TRUE(whole.ok()) << whole.status();
  EXPECT_EQ(whole->low, QuantityOf(*whole).minimum());
  EXPECT_EQ(whole->high, QuantityOf(*whole).maximum());
  const auto part = ReadVaried("trapped_air:1e-4:2e-3");
  ASSERT_TRUE(part.ok()) << part.status();
  EXPECT_EQ(part->low, 1e-4);
  EXPECT_EQ(part->high, 2e-3);
}

TEST(Varied, ReadsAndWritesTheParameter) {
  const auto varied = ReadVaried("trapped_air");
  v1::Parameters parameters;
  SetValue(*varied, 1e-3, parameters);
  EXPECT_EQ(parameters.trapped_air(), 1e-3);
  EXPECT_EQ(ValueOf(*varied, parameters), 1e-3);
}

TEST(Varied, IsRefusedWithTheReason) {
  EXPECT_THAT(Refusal("diafragm_activation"), HasSubstr("did you mean diaphragm_activation"));
  EXPECT_THAT(Refusal("posture"), HasSubstr("posture is no number"));
  EXPECT_THAT(Refusal("diaphragm_activation:1"), HasSubstr("NAME:LOW:HIGH"));
  EXPECT_THAT(Refusal("diaphragm_activation:0:x"), HasSubstr("diaphragm_activation: \"x\" is not a number"));
  EXPECT_THAT(Refusal("diaphragm_activation:-1:1"), HasSubstr("diaphragm_activation: -1 is outside 0 to 5"));
  EXPECT_THAT(Refusal("diaphragm_activation:nan:1"), HasSubstr("diaphragm_activation: nan"));
  EXPECT_THAT(Refusal("diaphragm_activation:1:1"), HasSubstr("lower bound 1 is not below 1"));
}

TEST(PresetText, IsReadAsTheSamePresetOfAScene) {
  v1::Preset preset;
  preset.set_name("quiet");
  preset.set_title("M\xc3\xbcller \"quiet\"");
  preset.set_group("Breathing patterns");
  preset.mutable_parameters()->set_diaphragm_activation(0.0613);
  preset.mutable_parameters()->set_posture(v1::POSTURE_UPRIGHT);
  const std::string text = PresetText(preset, "phrenic calibrate thorax");
  EXPECT_THAT(text, HasSubstr("# phrenic calibrate thorax\npresets {\n  name: \"quiet\"\n"));
  EXPECT_THAT(text, HasSubstr("M\xc3\xbcller"));
  EXPECT_THAT(text, HasSubstr("  parameters { diaphragm_activation: 0.0613 posture: POSTURE_UPRIGHT }\n}\n"));
  v1::Scene scene;
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &scene));
  ASSERT_EQ(scene.presets_size(), 1);
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(scene.presets(0), preset));
}

}  // namespace
}  // namespace phrenic::calibrate
