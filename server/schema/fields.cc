#include "server/schema/fields.h"

#include <array>
#include <charconv>
#include <cmath>

#include "absl/strings/str_cat.h"

namespace phrenic::schema {

using google::protobuf::FieldDescriptor;

const v1::Quantity* QuantityOf(const FieldDescriptor& field) {
  return field.options().HasExtension(v1::quantity) ? &field.options().GetExtension(v1::quantity) : nullptr;
}

const v1::Toggle* ToggleOf(const FieldDescriptor& field) {
  return field.options().HasExtension(v1::toggle) ? &field.options().GetExtension(v1::toggle) : nullptr;
}

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
