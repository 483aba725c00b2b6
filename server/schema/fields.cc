#include "server/schema/fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace phrenic::schema {

using google::protobuf::EnumDescriptor;
using google::protobuf::EnumValueDescriptor;
using google::protobuf::FieldDescriptor;

const v1::Quantity* QuantityOf(const FieldDescriptor& field) {
  return field.options().HasExtension(v1::quantity) ? &field.options().GetExtension(v1::quantity) : nullptr;
}

const v1::Toggle* ToggleOf(const FieldDescriptor& field) {
  return field.options().HasExtension(v1::toggle) ? &field.options().GetExtension(v1::toggle) : nullptr;
}

const v1::Choice* ChoiceOf(const FieldDescriptor& field) {
  return field.options().HasExtension(v1::choice) ? &field.options().GetExtension(v1::choice) : nullptr;
}

std::string ChoiceName(const EnumValueDescriptor& value) {
  // Values are prefixed with the first value's name up to "UNSPECIFIED" (buf's ENUM_VALUE_PREFIX).
  const size_t prefix = value.type()->value(0)->name().size() - std::string_view("UNSPECIFIED").size();
  return absl::AsciiStrToLower(value.name().substr(prefix));
}

std::vector<std::string> ChoiceNameList(const EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 1; i < type.value_count(); ++i) {
    const EnumValueDescriptor* value = type.value(i);
    if (type.FindValueByNumber(value->number()) == value) names.push_back(ChoiceName(*value));
  }
  return names;
}

std::string ChoiceNames(const EnumDescriptor& type) { return absl::StrJoin(ChoiceNameList(type), ", "); }

const EnumValueDescriptor* FindChoice(const EnumDescriptor& type, std::string_view name) {
  std::string wanted = absl::AsciiStrToLower(std::string(name));
  std::replace(wanted.begin(), wanted.end(), '-', '_');
  for (int i = 1; i < type.value_count(); ++i) {
    if (ChoiceName(*type.value(i)) == wanted) return type.value(i);
  }
  return nullptr;
}

std::string GroupOf(const FieldDescriptor& field) { return field.options().GetExtension(v1::group); }

bool IsRequired(const FieldDescriptor& field) { return field.options().GetExtension(v1::required); }

std::string FormatNumber(double value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), error == std::errc() ? end : text.data());
}

std::string FormatRange(const v1::Quantity& quantity) {
  const std::string unit = quantity.unit().empty() || quantity.unit() == "1" ? "" : " " + quantity.unit();
  return absl::StrCat(FormatNumber(quantity.minimum()), " to ", FormatNumber(quantity.maximum()), unit);
}

std::optional<std::string> NumberProblem(double value, const v1::Quantity* quantity) {
  if (!std::isfinite(value)) {
    const std::string allowed = quantity == nullptr ? "" : "; allowed is " + FormatRange(*quantity);
    return absl::StrCat(FormatNumber(value), " is not a finite number", allowed);
  }
  if (quantity == nullptr || (quantity->minimum() <= value && value <= quantity->maximum())) return std::nullopt;
  return absl::StrCat(FormatNumber(value), " is outside ", FormatRange(*quantity));
}

}  // namespace phrenic::schema
