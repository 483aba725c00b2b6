#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/schema/fields.h"
#include "server/schema/names.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

absl::Status NoSuchField(const Descriptor& type, std::string_view kind, std::string_view name) {
  constexpr size_t kLongestShown = 64;
  std::vector<std::string> names;
  names.reserve(type.field_count());
  for (int i = 0; i < type.field_count(); ++i) names.push_back(type.field(i)->name());
  const std::string shown(name.substr(0, kLongestShown));
  return absl::InvalidArgumentError(
      absl::StrCat("there is no ", std::string(kind), " \"", shown, "\"", ThereAre(shown, names)));
}

absl::Status SetToggle(const FieldDescriptor& field, const std::string& value, google::protobuf::Message* message) {
  const std::string text = absl::AsciiStrToLower(value);
  const bool on = text == "on" || text == "true" || text == "yes" || text == "1";
  const bool off = text == "off" || text == "false" || text == "no" || text == "0";
  if (!on && !off) {
    return absl::InvalidArgumentError(absl::StrCat(field.name(), ": \"", value, "\" is neither on nor off"));
  }
  message->GetReflection()->SetBool(message, &field, on);
  return absl::OkStatus();
}

absl::Status SetChoice(const FieldDescriptor& field, const std::string& text, google::protobuf::Message* message) {
  const google::protobuf::EnumValueDescriptor* value = FindChoice(*field.enum_type(), text);
  if (value == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat(field.name(), ": there is no \"", text, "\"", ThereAre(text, ChoiceNameList(*field.enum_type()))));
  }
  message->GetReflection()->SetEnum(message, &field, value);
  return absl::OkStatus();
}

absl::Status SetNumber(const FieldDescriptor& field, const std::string& text, google::protobuf::Message* message) {
  const v1::Quantity* quantity = QuantityOf(field);
  double value = 0;
  if (!absl::SimpleAtod(text, &value)) {
    return absl::InvalidArgumentError(absl::StrCat(field.name(), ": \"", text, "\" is not a number; allowed is ",
                                                   FormatRange(quantity == nullptr ? v1::Quantity() : *quantity)));
  }
  if (const auto problem = NumberProblem(value, quantity)) {
    return absl::InvalidArgumentError(absl::StrCat(field.name(), ": ", *problem));
  }
  message->GetReflection()->SetDouble(message, &field, value);
  return absl::OkStatus();
}

// Sets a field of a message whose fields are switches, choices and real numbers (tests/schema checks that).
absl::Status SetField(std::string_view kind, std::string_view name, std::string_view value,
                      google::protobuf::Message* message) {
  const Descriptor& type = *message->GetDescriptor();
  const FieldDescriptor* field = type.FindFieldByName(std::string(name));
  if (field == nullptr) return NoSuchField(type, kind, name);
  std::string text(value);
  absl::StripAsciiWhitespace(&text);
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return SetToggle(*field, text, message);
    case FieldDescriptor::CPPTYPE_ENUM:
      return SetChoice(*field, text, message);
    default:
      return SetNumber(*field, text, message);
  }
}

}  // namespace

absl::Status SetParameter(std::string_view name, std::string_view value, v1::Parameters* parameters) {
  return SetField("parameter", name, value, parameters);
}

absl::Status SetPhysique(std::string_view name, std::string_view value, v1::Physique* physique) {
  return SetField("number of a physique", name, value, physique);
}

}  // namespace phrenic::schema
