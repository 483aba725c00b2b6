#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr char kValid[] = R"(# Comments are allowed.
name: "sheet"
bodies {
  name: "sheet"
  role: ROLE_DEFORMABLE
  grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } }
}
forces { springs { bodies: "sheet" stiffness: 5 } }
)";

// The valid scene with `from` replaced by `to`.
std::string With(const std::string& from, const std::string& to) {
  std::string text = kValid;
  return text.replace(text.find(from), from.size(), to);
}

std::string Refusal(const std::string& text) {
  const auto scene = ParseScene("lung.textproto", text);
  EXPECT_EQ(scene.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(scene.status().message());
}

TEST(ParseScene, ReadsAValidScene) {
  const auto scene = ParseScene("lung.textproto", kValid);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(scene->name(), "sheet");
  EXPECT_EQ(scene->forces(0).springs().stiffness(), 5);
}

TEST(ParseScene, FillsNoDefaults) {
  const auto scene = ParseScene("lung.textproto", kValid);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_FALSE(scene->bodies(0).has_mass());
}

TEST(ParseScene, LocatesSyntaxErrors) {
  EXPECT_THAT(Refusal(With("role: ROLE_DEFORMABLE", "role = 1")), StartsWith("lung.textproto:5:8: "));
  EXPECT_THAT(Refusal(With("grid {", "grid ")), StartsWith("lung.textproto:6:"));
}

TEST(ParseScene, LocatesUnknownFieldsAndNamesThem) {
  const std::string refusal = Refusal(With("stiffness", "stifness"));
  EXPECT_THAT(refusal, StartsWith("lung.textproto:8:"));
  EXPECT_THAT(refusal, HasSubstr("stifness"));
}

TEST(ParseScene, LocatesUnknownEnumNames) {
  const std::string refusal = Refusal(With("ROLE_DEFORMABLE", "ROLE_SOFT"));
  EXPECT_THAT(refusal, StartsWith("lung.textproto:6:3: "));  // the parser has already read the next token
  EXPECT_THAT(refusal, HasSubstr("ROLE_SOFT"));
  EXPECT_THAT(refusal, HasSubstr("role"));
}

TEST(ParseScene, LocatesNumbersOutsideTheirRange) {
  EXPECT_EQ(Refusal(With("stiffness: 5", "stiffness: -5")),
            "lung.textproto:8:36: forces[0].springs.stiffness: -5 is outside 0 to 1e+09 N/m");
}

TEST(ParseScene, LocatesMissingFieldsAtTheirMessage) {
  EXPECT_EQ(Refusal(With("u { x: 1 }", "")), "lung.textproto:6:3: bodies[0].grid.u: must be set: every Grid needs it");
  EXPECT_THAT(Refusal(With("name: \"sheet\"\nbodies", "bodies")), StartsWith("lung.textproto: name: must be set"));
}

TEST(ParseScene, RefusesNaN) {
  EXPECT_THAT(Refusal(With("stiffness: 5", "stiffness: nan")), HasSubstr("nan is not a finite number"));
}

TEST(ParseScene, RefusesDeepNesting) {
  std::string text = kValid;
  for (int i = 0; i < 100000; ++i) text += "bodies { ";
  EXPECT_THAT(Refusal(text), StartsWith("lung.textproto:9:"));
}

TEST(ParseScene, RefusesAnEmptyFile) { EXPECT_THAT(Refusal(""), HasSubstr("name: must be set")); }

TEST(ParseScene, EveryShippedSceneIsValid) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PHRENIC_SOURCE_DIR "/server/scenes")) {
    if (entry.path().extension() != ".textproto") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const auto scene = ParseScene(entry.path().filename().string(), text.str());
    EXPECT_TRUE(scene.ok()) << scene.status();
    if (!scene.ok()) continue;
    EXPECT_EQ(scene->name(), entry.path().stem().string());
    ++scenes;
  }
  EXPECT_GE(scenes, 3);
}

// Buttons, lists and `phrenic describe` show these words.
TEST(ParseScene, EveryShippedPresetHasATitleAndSaysWhatToLookFor) {
  int presets = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PHRENIC_SOURCE_DIR "/server/scenes")) {
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const auto scene = ParseScene(entry.path().filename().string(), text.str());
    ASSERT_TRUE(scene.ok()) << scene.status();
    std::set<std::string> titles;
    for (const v1::Preset& preset : scene->presets()) {
      SCOPED_TRACE(absl::StrCat(scene->name(), ", ", preset.name()));
      EXPECT_FALSE(preset.title().empty());
      EXPECT_LE(preset.title().size(), 24U) << "too long for a button";
      EXPECT_TRUE(titles.insert(preset.title()).second) << "two presets of this title";
      EXPECT_TRUE(preset.description().ends_with('.')) << preset.description();
      EXPECT_EQ(preset.group().empty(), scene->presets(0).group().empty()) << "all presets have a group, or none";
      ++presets;
    }
  }
  EXPECT_GT(presets, 40);
}

}  // namespace
}  // namespace phrenic::schema
