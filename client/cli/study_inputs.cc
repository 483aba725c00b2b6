#include "client/cli/study_inputs.h"

#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/argument_kinds.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

constexpr size_t kLongestQuoted = 64;
constexpr const char* kInputForms =
    "NAME:LOW:HIGH, NAME:triangular:LOW:MODE:HIGH, NAME:normal:MEAN:DEVIATION or NAME:lognormal:MEDIAN:FACTOR";

absl::Status NotAnInput(const std::string& text) {
  return absl::InvalidArgumentError(
      absl::StrCat("\"", text.substr(0, kLongestQuoted), "\" is not of the form ", kInputForms));
}

// Reads the words from `first` on. Returns false if one is not a number.
bool ReadNumbers(const std::vector<std::string>& words, size_t first, std::vector<double>& numbers) {
  for (size_t i = first; i < words.size(); ++i) {
    if (!absl::SimpleAtod(words[i], &numbers.emplace_back())) return false;
  }
  return true;
}

// Sets the distribution of that name. Returns false if it does not exist or takes another number of numbers.
bool SetLawOf(const std::string& law, const std::vector<double>& numbers, v1::UncertainInput& input) {
  if (law == "uniform" && numbers.size() == 2) {
    input.mutable_uniform()->set_low(numbers[0]);
    input.mutable_uniform()->set_high(numbers[1]);
  } else if (law == "triangular" && numbers.size() == 3) {
    input.mutable_triangular()->set_low(numbers[0]);
    input.mutable_triangular()->set_mode(numbers[1]);
    input.mutable_triangular()->set_high(numbers[2]);
  } else if (law == "normal" && numbers.size() == 2) {
    input.mutable_normal()->set_mean(numbers[0]);
    input.mutable_normal()->set_deviation(numbers[1]);
  } else if (law == "lognormal" && numbers.size() == 2) {
    input.mutable_log_normal()->set_median(numbers[0]);
    input.mutable_log_normal()->set_factor(numbers[1]);
  } else {
    return false;
  }
  return true;
}

}  // namespace

absl::StatusOr<v1::UncertainInput> ReadUncertainInput(const std::string& text) {
  const std::vector<std::string> words = absl::StrSplit(text, ':');
  v1::UncertainInput input;
  if (words[0].empty() || words.size() < 3) return NotAnInput(text);
  input.set_parameter(words[0]);
  const bool named = words.size() > 3 || words[1] == "uniform";
  std::vector<double> numbers;
  if (!ReadNumbers(words, named ? 2 : 1, numbers)) return NotAnInput(text);
  if (!SetLawOf(named ? words[1] : "uniform", numbers, input)) return NotAnInput(text);
  return input;
}

absl::StatusOr<v1::StudiedOutput> ReadStudiedOutput(const std::string& text) {
  v1::StudiedOutput output;
  const size_t colon = text.rfind(':');
  output.set_measure(text.substr(0, colon));
  if (output.measure().empty()) return absl::InvalidArgumentError("a measure needs a name");
  if (colon == std::string::npos) return output;
  const std::string statistic = text.substr(colon + 1);
  const auto* value = schema::FindChoice(*v1::Statistic_descriptor(), statistic);
  if (value == nullptr || value->number() == v1::STATISTIC_UNSPECIFIED) {
    return absl::InvalidArgumentError(absl::StrCat("there is no statistic \"", statistic.substr(0, kLongestQuoted),
                                                   "\"; there are ", schema::ChoiceNames(*v1::Statistic_descriptor())));
  }
  output.set_statistic(static_cast<v1::Statistic>(value->number()));
  return output;
}

void AddInputs(CLI::App& command, google::protobuf::RepeatedPtrField<v1::UncertainInput>* inputs) {
  command
      .add_option_function<std::vector<std::string>>(
          "--vary",
          [inputs](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) *inputs->Add() = *ReadUncertainInput(text);
          },
          absl::StrCat("an uncertain live parameter: ", kInputForms, "; may be repeated"))
      ->check(ParsedBy([](const std::string& text) { return ReadUncertainInput(text).status(); }))
      ->allow_extra_args(false)
      ->required();
}

void AddOutputs(CLI::App& command, google::protobuf::RepeatedPtrField<v1::StudiedOutput>* outputs) {
  command
      .add_option_function<std::vector<std::string>>(
          "--measure",
          [outputs](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) *outputs->Add() = *ReadStudiedOutput(text);
          },
          absl::StrCat("an output: a measure of a breath (tidal-volume), or a measure of the scene and its ",
                       schema::ChoiceNames(*v1::Statistic_descriptor()), "; may be repeated (all)"))
      ->check(ParsedBy([](const std::string& text) { return ReadStudiedOutput(text).status(); }))
      ->allow_extra_args(false);
}

}  // namespace phrenic::client
