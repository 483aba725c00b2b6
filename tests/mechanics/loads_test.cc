// What drags and point loads say of scenes that they cannot follow.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/mechanics/lungs/mode_parameters.h"
#include "tests/compile_text.h"
#include "tests/small_scenes.h"

namespace phrenic {
namespace {

using testing::HasSubstr;

std::string Refusal(const std::string& force) {
  const auto made = TryCompileText(Triangle("forces { " + force + " }"));
  EXPECT_EQ(made.status().code(), absl::StatusCode::kInvalidArgument) << force;
  return std::string(made.status().message());
}

// Why the force that comes after the triangle's own is left out; empty where it runs.
std::string WhyLeftOut(const std::string& force) {
  const auto model = CompileText(Triangle("forces { name: 'new' " + force + " }"));
  for (const v1::LeftOut& row : model->report.left_out()) {
    if (row.what() == "new") return row.why();
  }
  return "";
}

TEST(TargetSpring, SaysWhatIsWrongWithIt) {
  EXPECT_EQ(Refusal("target_spring { bodies: 'sheet' }"),
            "forces[3].target_spring: says no target: set displacement, point or surface");
  EXPECT_THAT(Refusal("target_spring { bodies: 'sheet' vertices: 7 point {} }"),
              HasSubstr("forces[3].target_spring.vertices[0]: there"));
  EXPECT_THAT(Refusal("target_spring { bodies: 'sheet' region: 'rim' point {} }"),
              HasSubstr("forces[3].target_spring.region"));
  EXPECT_THAT(Refusal("target_spring { bodies: 'post' point {} }"), HasSubstr("must be ROLE_DEFORMABLE"));
  EXPECT_THAT(Refusal("target_spring { bodies: 'sheet' surface: 'post' }"), HasSubstr("has no triangles to draw to"));
  EXPECT_THAT(Refusal("target_spring { bodies: 'sheet' surface: 'sheet' }"),
              HasSubstr("name a body that is driven or at rest"));
  EXPECT_THAT(Refusal("target_spring { bodies: 'sheet' point {} stiffness: -1 }"),
              HasSubstr("-1 is outside 0 to 1e+09 N/m"));
}

TEST(PointLoad, SaysWhatIsWrongWithIt) {
  EXPECT_EQ(Refusal("point_load { body: 'sheet' force { z: 1 } }"),
            "forces[3].point_load: says no place: set vertices, or a region");
  EXPECT_THAT(Refusal("point_load { body: 'sheet' vertices: 1 region: 'rim' force { z: 1 } }"),
              HasSubstr("set one of the two"));
  EXPECT_THAT(Refusal("point_load { body: 'sheet' vertices: -1 force { z: 1 } }"), HasSubstr("vertices[0]"));
  EXPECT_THAT(Refusal("point_load { body: 'sheet' vertices: 1 }"), HasSubstr("force: must be set"));
}

TEST(Loads, OnWhatCannotMoveAreLeftOut) {
  EXPECT_EQ(WhyLeftOut("point_load { body: 'sheet' vertices: 0 force { z: 1 } }"), "none of its vertices is free");
  EXPECT_EQ(WhyLeftOut("point_load { body: 'sheet' vertices: 1 force {} }"), "its force is 0");
  EXPECT_EQ(WhyLeftOut("target_spring { bodies: 'sheet' vertices: 0 point {} }"), "none of its vertices is free");
  EXPECT_EQ(WhyLeftOut("target_spring { bodies: 'sheet' stiffness: 0 point {} }"), "its stiffness is 0");
  EXPECT_EQ(WhyLeftOut("target_spring { bodies: 'sheet' point {} }"), "");
}

TEST(Parameters, ThatNothingAnswersToAreReported) {
  const auto idle = [](const std::string& more) {
    const auto model = CompileText(Triangle(more));
    return std::vector<std::string>(model->report.idle_parameters().begin(), model->report.idle_parameters().end());
  };
  std::vector<std::string> named = idle("");
  std::erase_if(named, [](const std::string& name) {  // lungs/lung_modes_test.cc
    return std::ranges::any_of(ModeParameters(), [&](const ModeParameter& each) { return each.name == name; });
  });
  EXPECT_THAT(
      named,
      testing::UnorderedElementsAre(
          "rib_motion", "pump_handle", "bucket_handle", "apply_muscles", "hyperinflation", "diaphragm_activation",
          "right_activation", "left_activation", "apply_links", "intercostal_activation", "chest_wall_compliance",
          "muscle_strength", "expiratory_activation", "airway_resistance", "lung_compliance", "abdominal_compliance",
          "abdominal_load", "airway_pressure", "ventilator_pressure", "airway_closed", "trapped_air",
          "pneumothorax_right", "pneumothorax_left", "pleural_fluid_right", "pleural_fluid_left", "posture",
          "inspiratory_share", "pause_share", "waxing", "glottis_share", "right_intercostals", "left_intercostals",
          "right_cage_compliance", "left_cage_compliance", "cage_tilt", "flail_right", "flail_left"));
  EXPECT_THAT(idle("constraints { length_limits { body: 'sheet' at_most_ratio: 2 } }"),
              testing::Not(testing::Contains("apply_links")));
  EXPECT_THAT(idle("forces { action_line { bodies: 'sheet' origin {} direction { z: 1 } radius: 3 force: 1 } }"),
              testing::Not(testing::Contains("apply_muscles")));
}

}  // namespace
}  // namespace phrenic
