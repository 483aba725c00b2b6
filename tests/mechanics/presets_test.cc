// Presets of a scene.
#include "server/mechanics/compile/presets.h"

#include <gtest/gtest.h>

#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

std::shared_ptr<const Model> WithPresets() {
  return CompileText(Retimed("time_step: 0.01 breath_force: 1.5") + R"(
    presets { name: "deep" parameters { breath_force: 2 } }
    presets { name: "loose" parameters { apply_links: false } })");
}

TEST(Presets, CanBeChosenOneAfterTheOther) {
  const auto model = WithPresets();
  v1::Parameters straight = model->parameters, after_another = model->parameters;
  straight.MergeFrom(*FindPreset(model->scene, "loose"));
  after_another.MergeFrom(*FindPreset(model->scene, "deep"));
  after_another.MergeFrom(*FindPreset(model->scene, "loose"));
  EXPECT_EQ(after_another.SerializeAsString(), straight.SerializeAsString());
  EXPECT_EQ(straight.breath_force(), 1.5);
}

TEST(Presets, LeaveAloneWhatNoneOfThemSets) {
  const auto deep = FindPreset(WithPresets()->scene, "deep");
  ASSERT_TRUE(deep.ok());
  EXPECT_TRUE(deep->has_apply_links());
  EXPECT_FALSE(deep->has_time_step());
  EXPECT_FALSE(deep->has_breath_length());
}

}  // namespace
}  // namespace phrenic
