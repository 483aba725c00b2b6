#include "client/credibility/command_text.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/cli/shell_word.h"
#include "phrenic/v1/uncertainty.pb.h"
#include "server/schema/fields.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using schema::FormatNumber;

std::string InputText(const v1::UncertainInput& input) {
  const std::string& name = input.parameter();
  const auto text = [&name](const char* law, const std::vector<double>& numbers) {
    return absl::StrCat(name, law, ":", absl::StrJoin(numbers, ":", [](std::string* out, double number) {
                          absl::StrAppend(out, FormatNumber(number));
                        }));
  };
  if (input.has_triangular()) {
    return text(":triangular", {input.triangular().low(), input.triangular().mode(), input.triangular().high()});
  }
  if (input.has_normal()) return text(":normal", {input.normal().mean(), input.normal().deviation()});
  if (input.has_log_normal()) return text(":lognormal", {input.log_normal().median(), input.log_normal().factor()});
  return text("", {input.uniform().low(), input.uniform().high()});
}

std::string OutputText(const v1::StudiedOutput& output) {
  if (output.statistic() == v1::STATISTIC_UNSPECIFIED) return output.measure();
  return absl::StrCat(output.measure(), ":",
                      schema::ChoiceName(*v1::Statistic_descriptor()->FindValueByNumber(output.statistic())));
}

// Returns the value of a scalar field, or of one of its elements.
std::string FieldText(const Message& message, const FieldDescriptor& field, int element) {
  const auto& reflection = *message.GetReflection();
  const bool one = element < 0;
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return FormatNumber(one ? reflection.GetDouble(message, &field)
                              : reflection.GetRepeatedDouble(message, &field, element));
    case FieldDescriptor::CPPTYPE_INT32:
      return absl::StrCat(reflection.GetInt32(message, &field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, &field) ? "on" : "off";
    case FieldDescriptor::CPPTYPE_ENUM:
      return schema::ChoiceName(
          *(one ? reflection.GetEnum(message, &field) : reflection.GetRepeatedEnum(message, &field, element)));
    default:
      return "";
  }
}

std::string StudyOptionsOf(const Message& study) {
  std::string text;
  const auto& reflection = *study.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(study, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) continue;
    std::vector<std::string> values;
    if (field->is_repeated()) {
      for (int i = 0; i < reflection.FieldSize(study, field); ++i) values.push_back(FieldText(study, *field, i));
    } else {
      values.push_back(FieldText(study, *field, -1));
    }
    absl::StrAppend(&text, " --", absl::StrReplaceAll(field->name(), {{"_", "-"}}), " ", absl::StrJoin(values, ","));
  }
  return text;
}

template <typename Study>
std::string InputsOf(const Message& message) {
  std::string text;
  const auto* study = dynamic_cast<const Study*>(&message);
  if (study == nullptr) return text;
  for (const v1::UncertainInput& input : study->inputs())
    absl::StrAppend(&text, " --vary ", ShellWord(InputText(input)));
  return text;
}

template <typename Study>
std::string OutputsOf(const Message& message) {
  std::string text;
  const auto* study = dynamic_cast<const Study*>(&message);
  if (study == nullptr) return text;
  for (const v1::StudiedOutput& each : study->outputs())
    absl::StrAppend(&text, " --measure ", ShellWord(OutputText(each)));
  return text;
}

std::string SetOptionsOf(const v1::Parameters& parameters) {
  std::string text;
  std::vector<const FieldDescriptor*> fields;
  parameters.GetReflection()->ListFields(parameters, &fields);
  for (const FieldDescriptor* field : fields) {
    absl::StrAppend(&text, " --set ", field->name(), "=", FieldText(parameters, *field, -1));
  }
  return text;
}

}  // namespace

std::string StudyCommand(const std::string& kind, const std::string& scene, const std::string& preset,
                         const v1::Parameters& parameters, const Message& study) {
  std::string text = absl::StrCat("phrenic study ", kind, " ", scene);
  if (!preset.empty()) absl::StrAppend(&text, " --preset ", ShellWord(preset));
  return absl::StrCat(text, SetOptionsOf(parameters), InputsOf<v1::SensitivityStudy>(study),
                      InputsOf<v1::UncertaintyStudy>(study), OutputsOf<v1::SensitivityStudy>(study),
                      OutputsOf<v1::UncertaintyStudy>(study), OutputsOf<v1::ConvergenceStudy>(study),
                      StudyOptionsOf(study));
}

}  // namespace phrenic::client
