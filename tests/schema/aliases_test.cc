// Older names of fields: each is accepted, and means what the new name means.
#include "server/schema/aliases.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "phrenic/v1/options.pb.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using testing::HasSubstr;

// Every older name in a scene.
std::vector<const FieldDescriptor*> Aliases() {
  std::vector<const FieldDescriptor*> aliases;
  std::set<const Descriptor*> seen;
  const std::function<void(const Descriptor*)> walk = [&](const Descriptor* type) {
    if (!seen.insert(type).second) return;
    for (int i = 0; i < type->field_count(); ++i) {
      if (!type->field(i)->options().GetExtension(v1::alias_of).empty()) aliases.push_back(type->field(i));
      if (type->field(i)->message_type() != nullptr) walk(type->field(i)->message_type());
    }
  };
  walk(v1::Scene::descriptor());
  return aliases;
}

// A scene of one body, with `body`'s fields, and other elements.
std::string SceneText(const std::string& body, const std::string& elements) {
  return "name: 's'\nbodies { name: 'b' role: ROLE_DEFORMABLE polyhedron { vertices {} } " + body + " }\n" + elements;
}

std::string AliasRefusal(const std::string& text) { return std::string(ParseScene("s", text).status().message()); }

TEST(Aliases, StandForAnotherFieldOfTheSameType) {
  for (const FieldDescriptor* alias : Aliases()) {
    const auto* target = alias->containing_type()->FindFieldByName(alias->options().GetExtension(v1::alias_of));
    ASSERT_NE(target, nullptr) << alias->full_name();
    EXPECT_TRUE(target->options().GetExtension(v1::alias_of).empty()) << alias->full_name();
    EXPECT_EQ(alias->type(), target->type()) << alias->full_name();
    EXPECT_EQ(alias->is_repeated(), target->is_repeated()) << alias->full_name();
    EXPECT_EQ(alias->message_type(), target->message_type()) << alias->full_name();
    EXPECT_EQ(alias->enum_type(), target->enum_type()) << alias->full_name();
    EXPECT_EQ(alias->real_containing_oneof(), nullptr) << alias->full_name() << " would be a kind of its own";
    const bool message = alias->message_type() != nullptr && !alias->is_repeated();
    const bool choice = alias->enum_type() != nullptr && !alias->is_repeated() && alias->has_presence();
    const bool texts = alias->type() == FieldDescriptor::TYPE_STRING && alias->is_repeated();
    EXPECT_TRUE(message || choice || texts) << alias->full_name() << ": MoveAliases moves no such type";
  }
}

struct Renaming {
  std::string alias;  // "Force.drag"
  std::string before, after;
};

const std::vector<Renaming>& Renamings() {
  static const std::vector<Renaming> all = {
      {"Body.mass_shares", SceneText("mass_shares: MASS_SHARES_BY_STIFFNESS", ""),
       SceneText("mass_lumping: MASS_LUMPING_BY_STIFFNESS", "")},
      {"Body.substance", SceneText("substance { density: 2 }", ""), SceneText("material { density: 2 }", "")},
      {"Force.drag", SceneText("", "forces { drag { bodies: 'b' point { x: 1 } } }"),
       SceneText("", "forces { target_spring { bodies: 'b' point { x: 1 } } }")},
      {"Attachment.carriers", SceneText("", "forces { attachment { bodies: 'b' carriers: ['c', 'd'] radius: 1 } }"),
       SceneText("", "forces { attachment { bodies: 'b' anchors: ['c', 'd'] radius: 1 } }")},
      {"Motion.ride", SceneText("", "motions { ride { bodies: 'b' drivers: 'c' mode: RIDE_MODE_TRIANGLES } }"),
       SceneText("", "motions { skin { bodies: 'b' drivers: 'c' mode: SKIN_MODE_TRIANGLES } }")},
      {"Skin.carriers", SceneText("", "motions { ride { bodies: 'b' carriers: ['c', 'd'] } }"),
       SceneText("", "motions { skin { bodies: 'b' drivers: ['c', 'd'] } }")},
      {"Constraint.limits", SceneText("", "constraints { limits { body: 'b' at_most_ratio: 2 } }"),
       SceneText("", "constraints { length_limits { body: 'b' at_most_ratio: 2 } }")},
  };
  return all;
}

TEST(Aliases, AreAllAcceptedInTextAndMeanTheNewName) {
  std::set<std::string> tried;
  for (const Renaming& renaming : Renamings()) {
    tried.insert("phrenic.v1." + renaming.alias);
    const auto before = ParseScene("s", renaming.before), after = ParseScene("s", renaming.after);
    ASSERT_TRUE(before.ok()) << renaming.alias << ": " << before.status();
    ASSERT_TRUE(after.ok()) << renaming.alias << ": " << after.status();
    EXPECT_EQ(before->SerializeAsString(), after->SerializeAsString()) << renaming.alias;
  }
  for (const FieldDescriptor* alias : Aliases()) EXPECT_TRUE(tried.contains(alias->full_name())) << alias->full_name();
}

TEST(Aliases, OlderNamesOfEnumValuesAreAccepted) {
  for (const std::string value : {"UNSPECIFIED", "NEAREST_VERTICES", "TRIANGLES"}) {
    const std::string text = "motions { skin { bodies: 'b' drivers: 'c' mode: ";
    const auto before = ParseScene("s", SceneText("", text + "RIDE_MODE_" + value + " } }"));
    const auto after = ParseScene("s", SceneText("", text + "SKIN_MODE_" + value + " } }"));
    ASSERT_TRUE(before.ok() && after.ok()) << value;
    EXPECT_EQ(before->SerializeAsString(), after->SerializeAsString());
    EXPECT_THAT(before->DebugString(), testing::Not(HasSubstr("RIDE_MODE")));
  }
  for (const std::string value : {"UNSPECIFIED", "BY_AREA", "BY_STIFFNESS"}) {
    const auto before = ParseScene("s", SceneText("mass_lumping: MASS_SHARES_" + value, ""));
    const auto after = ParseScene("s", SceneText("mass_lumping: MASS_LUMPING_" + value, ""));
    ASSERT_TRUE(before.ok() && after.ok()) << value;
    EXPECT_EQ(before->SerializeAsString(), after->SerializeAsString());
  }
}

TEST(Aliases, ErrorsHaveTheLineOfTheOlderNameAndTheWordsOfTheNew) {
  EXPECT_EQ(AliasRefusal(SceneText("", "forces { drag { bodies: 'b' point {} stiffness: -1 } }")),
            "s:3:38: forces[0].target_spring.stiffness: -1 is outside 0 to 1e+09 N/m");
  EXPECT_EQ(AliasRefusal(SceneText("", "motions {\n  ride { carriers: 'c' } }")),
            "s:4:3: motions[0].skin.bodies: must not be empty: every Skin needs at least one");
}

TEST(Aliases, TheyAreNotSetBesideTheNewNameOrAnotherKind) {
  EXPECT_EQ(AliasRefusal(SceneText("", "motions { skin { bodies: 'b' drivers: 'c' carriers: 'd' } }")),
            "s:3:30: motions[0].skin.drivers: is set twice, once as carriers: set it once");
  EXPECT_EQ(
      AliasRefusal(SceneText("", "forces { gravity { bodies: 'b' acceleration {} }\n drag { bodies: 'b' point {} } }")),
      "s:4:2: forces[0].target_spring: is set together with gravity: set one of them");
}

TEST(Aliases, ScenesThatAreSentAreResolvedToo) {
  v1::Scene scene = *ParseScene("s", SceneText("", ""));
  google::protobuf::TextFormat::MergeFromString("forces { drag { bodies: 'b' } }", &scene);
  ASSERT_TRUE(Resolve(&scene).ok());
  EXPECT_TRUE(scene.forces(0).has_target_spring());
}

TEST(Aliases, AreInNoListOfAllowedValues) {
  v1::Scene scene = *ParseScene("s", SceneText("", "motions { skin { bodies: 'b' drivers: 'c' } }"));
  scene.mutable_motions(0)->mutable_skin()->set_mode(static_cast<v1::SkinMode>(9));
  EXPECT_EQ(std::string(Validate(scene).message()),
            "motions[0].skin.mode: 9 is not one of SKIN_MODE_NEAREST_VERTICES, SKIN_MODE_TRIANGLES, "
            "SKIN_MODE_SHEET, SKIN_MODE_SMOOTH, SKIN_MODE_BAR");
}

}  // namespace
}  // namespace phrenic::schema
