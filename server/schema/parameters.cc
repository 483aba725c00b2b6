#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/schema/describe.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;

// Levenshtein distance: single-letter insertions, deletions and changes.
size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}

absl::Status UnknownParameter(std::string_view name) {
  const google::protobuf::Descriptor& type = *v1::Parameters::descriptor();
  std::vector<std::string> names;
  for (int f = 0; f < type.field_count(); ++f) names.emplace_back(type.field(f)->name());
  const auto nearest = std::min_element(names.begin(), names.end(), [name](const auto& a, const auto& b) {
    return EditDistance(name, a) < EditDistance(name, b);
  });
  return absl::InvalidArgumentError(absl::StrCat("there is no parameter \"", std::string(name), "\"; did you mean ",
                                                 *nearest, "? There are ", absl::StrJoin(names, ", ")));
}

absl::Status SetNumber(const FieldDescriptor& field, std::string_view text, v1::Parameters* parameters) {
  const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
  double value = 0;
  const bool number = absl::SimpleAtod(absl::string_view(text.data(), text.size()), &value);
  if (!number || !(value >= quantity.minimum() && value <= quantity.maximum())) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(field.name()), ": \"", std::string(text), "\" ",
                                                   number ? "is outside " : "is not a number in ", Range(quantity)));
  }
  parameters->GetReflection()->SetDouble(parameters, &field, value);
  return absl::OkStatus();
}

absl::Status SetSwitch(const FieldDescriptor& field, std::string_view text, v1::Parameters* parameters) {
  const std::string word = absl::AsciiStrToLower(absl::string_view(text.data(), text.size()));
  const bool on = word == "on" || word == "true" || word == "yes" || word == "1";
  const bool off = word == "off" || word == "false" || word == "no" || word == "0";
  if (!on && !off) {
    return absl::InvalidArgumentError(
        absl::StrCat(std::string(field.name()), ": \"", std::string(text), "\" is neither on nor off"));
  }
  parameters->GetReflection()->SetBool(parameters, &field, on);
  return absl::OkStatus();
}

}  // namespace

absl::Status SetParameter(std::string_view name, std::string_view value, v1::Parameters* parameters) {
  const FieldDescriptor* field = v1::Parameters::descriptor()->FindFieldByName(std::string(name));
  if (field == nullptr) return UnknownParameter(name);
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) return SetSwitch(*field, value, parameters);
  return SetNumber(*field, value, parameters);
}

}  // namespace phrenic::schema
