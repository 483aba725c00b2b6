#include "server/calibrate/varied.h"

#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/schema/fields.h"
#include "server/schema/names.h"

namespace phrenic::calibrate {
namespace {

constexpr size_t kLongestShown = 64;

std::vector<std::string> NumberNames() {
  std::vector<std::string> names;
  const auto& type = *v1::Parameters::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    if (schema::QuantityOf(*type.field(i)) != nullptr) names.push_back(type.field(i)->name());
  }
  return names;
}

absl::Status ReadBound(const std::string& text, const Varied& varied, double* bound) {
  const v1::Quantity& quantity = QuantityOf(varied);
  if (!absl::SimpleAtod(text, bound)) {
    return absl::InvalidArgumentError(absl::StrCat(varied.field->name(), ": \"", text.substr(0, kLongestShown),
                                                   "\" is not a number; allowed is ", schema::FormatRange(quantity)));
  }
  if (const auto problem = schema::NumberProblem(*bound, &quantity)) {
    return absl::InvalidArgumentError(absl::StrCat(varied.field->name(), ": ", *problem));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Varied> ReadVaried(const std::string& text) {
  const std::vector<std::string> words = absl::StrSplit(text, ':');
  const std::string shown = words[0].substr(0, kLongestShown);
  const auto* field = v1::Parameters::descriptor()->FindFieldByName(words[0]);
  if (field == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("there is no parameter \"", shown, "\"", schema::ThereAre(shown, NumberNames())));
  }
  if (schema::QuantityOf(*field) == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat(shown, " is no number, so that no range of it can be searched"));
  }
  if (words.size() != 1 && words.size() != 3) {
    return absl::InvalidArgumentError(absl::StrCat(
        "\"", text.substr(0, kLongestShown), "\" is not of the form NAME or NAME:LOW:HIGH, such as ", shown, ":0:0.5"));
  }
  Varied varied{field, schema::QuantityOf(*field)->minimum(), schema::QuantityOf(*field)->maximum()};
  if (words.size() == 1) return varied;
  if (absl::Status status = ReadBound(words[1], varied, &varied.low); !status.ok()) return status;
  if (absl::Status status = ReadBound(words[2], varied, &varied.high); !status.ok()) return status;
  if (varied.low < varied.high) return varied;
  return absl::InvalidArgumentError(absl::StrCat(shown, ": the lower bound ", words[1], " is not below ", words[2]));
}

const v1::Quantity& QuantityOf(const Varied& varied) { return *schema::QuantityOf(*varied.field); }

double StepOf(const Varied& varied) {
  const double increment = QuantityOf(varied).increment();
  return increment > 0 ? increment : (varied.high - varied.low) / 100;
}

double ValueOf(const Varied& varied, const v1::Parameters& parameters) {
  return parameters.GetReflection()->GetDouble(parameters, varied.field);
}

void SetValue(const Varied& varied, double value, v1::Parameters& parameters) {
  parameters.GetReflection()->SetDouble(&parameters, varied.field, value);
}

}  // namespace phrenic::calibrate
