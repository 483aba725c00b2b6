// Laws that hold for every field of the schema.
#include "server/schema/schema.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "phrenic/v1/export.pb.h"
#include "phrenic/v1/frames.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/schema/fields.h"

namespace phrenic::schema {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

// Visits every field of every request.
void ForEachField(const std::function<void(const FieldDescriptor&)>& visit) {
  std::set<const Descriptor*> seen;
  const std::function<void(const Descriptor*)> walk = [&](const Descriptor* type) {
    if (!seen.insert(type).second) return;
    for (int i = 0; i < type->field_count(); ++i) {
      visit(*type->field(i));
      if (type->field(i)->message_type() != nullptr) walk(type->field(i)->message_type());
    }
  };
  for (const auto* file : {v1::SceneSource::descriptor()->file(), v1::CreateExportRequest::descriptor()->file(),
                           v1::WatchFramesRequest::descriptor()->file()}) {
    for (int i = 0; i < file->message_type_count(); ++i) walk(file->message_type(i));
  }
}

bool IsNumber(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_INT64:
      return true;
    default:
      return false;
  }
}

TEST(Schema, QuantitiesAreOnNumbersWithUnitAndRange) {
  int quantities = 0;
  ForEachField([&](const FieldDescriptor& field) {
    const v1::Quantity* quantity = QuantityOf(field);
    if (quantity == nullptr) return;
    ++quantities;
    EXPECT_TRUE(IsNumber(field)) << field.full_name();
    EXPECT_FALSE(quantity->unit().empty()) << field.full_name() << " has no unit; a pure number's is \"1\"";
    EXPECT_LT(quantity->minimum(), quantity->maximum()) << field.full_name();
  });
  EXPECT_GT(quantities, 20);
}

TEST(Schema, DefaultsLieInTheirRanges) {
  ForEachField([](const FieldDescriptor& field) {
    const v1::Quantity* quantity = QuantityOf(field);
    if (quantity == nullptr || quantity->automatic() || !field.has_presence()) return;
    EXPECT_EQ(NumberProblem(quantity->default_value(), quantity), std::nullopt) << field.full_name();
  });
}

TEST(Schema, TogglesAreOnBooleansWithPresence) {
  ForEachField([](const FieldDescriptor& field) {
    if (ToggleOf(field) == nullptr) return;
    EXPECT_EQ(field.cpp_type(), FieldDescriptor::CPPTYPE_BOOL) << field.full_name();
    EXPECT_TRUE(field.has_presence()) << field.full_name() << " must be optional";
  });
}

TEST(Schema, ChoicesAreOnEnumsWithADefaultAmongTheirValues) {
  ForEachField([](const FieldDescriptor& field) {
    const v1::Choice* choice = ChoiceOf(field);
    if (choice == nullptr) return;
    ASSERT_EQ(field.cpp_type(), FieldDescriptor::CPPTYPE_ENUM) << field.full_name();
    EXPECT_TRUE(field.has_presence()) << field.full_name() << " must be optional";
    EXPECT_NE(field.enum_type()->FindValueByNumber(choice->default_value()), nullptr) << field.full_name();
    EXPECT_GT(choice->default_value(), 0) << field.full_name();
  });
}

TEST(Schema, ChoicesAreNamedWithoutTheirPrefix) {
  const google::protobuf::EnumDescriptor& type = *v1::Integrator_descriptor();
  EXPECT_EQ(ChoiceName(*type.FindValueByNumber(v1::INTEGRATOR_SEMI_IMPLICIT_EULER)), "semi_implicit_euler");
  for (int i = 1; i < type.value_count(); ++i) EXPECT_EQ(FindChoice(type, ChoiceName(*type.value(i))), type.value(i));
  EXPECT_EQ(FindChoice(type, "Semi-Implicit-Euler"), type.FindValueByNumber(v1::INTEGRATOR_SEMI_IMPLICIT_EULER));
  EXPECT_EQ(FindChoice(type, "unspecified"), nullptr);
}

TEST(Schema, ParametersAreOptionalRealsSwitchesAndChoicesWithLabelAndHelp) {
  const Descriptor& type = *v1::Parameters::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    EXPECT_TRUE(field.has_presence()) << field.name();
    std::string label, help;
    if (const v1::Quantity* quantity = QuantityOf(field)) {
      EXPECT_EQ(field.cpp_type(), FieldDescriptor::CPPTYPE_DOUBLE);
      label = quantity->label(), help = quantity->help();
    } else if (const v1::Toggle* toggle = ToggleOf(field)) {
      label = toggle->label(), help = toggle->help();
    } else if (const v1::Choice* choice = ChoiceOf(field)) {
      label = choice->label(), help = choice->help();
    }
    EXPECT_FALSE(label.empty()) << field.name() << " needs a quantity, a toggle or a choice, with a label";
    EXPECT_FALSE(help.empty()) << field.name();
  }
}

TEST(Schema, ParametersOfAGroupStandTogether) {
  const Descriptor& type = *v1::Parameters::descriptor();
  std::set<std::string> seen;
  std::string group;
  for (int i = 0; i < type.field_count(); ++i) {
    const std::string next = GroupOf(*type.field(i));
    EXPECT_FALSE(next.empty()) << type.field(i)->name() << " has no group";
    EXPECT_TRUE(next == group || seen.insert(next).second) << type.field(i)->name() << " is apart from " << next;
    group = next;
  }
  EXPECT_GE(seen.size(), 4U);
  EXPECT_EQ(GroupOf(*v1::Scene::descriptor()->FindFieldByName("name")), "");
}

TEST(Schema, NumbersAreWrittenAsShortAsTheyReadBack) {
  EXPECT_EQ(FormatNumber(0.1), "0.1");
  EXPECT_EQ(FormatNumber(1e9), "1e+09");
  EXPECT_EQ(FormatNumber(-2.5), "-2.5");
  EXPECT_EQ(std::stod(FormatNumber(1.0 / 3)), 1.0 / 3);
}

}  // namespace
}  // namespace phrenic::schema
