#include "client/cli/schema_options.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Returns the value. Throws CLI::ValidationError if the schema does not allow it.
double Checked(const FieldDescriptor& field, double value) {
  if (const auto problem = schema::NumberProblem(value, schema::QuantityOf(field))) {
    throw CLI::ValidationError(field.name(), *problem);
  }
  return value;
}

void SetNumber(Message* message, const FieldDescriptor* field, double value) {
  const auto& reflection = *message->GetReflection();
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_INT32) {
    reflection.SetInt32(message, field, static_cast<int>(Checked(*field, value)));
  } else {
    reflection.SetDouble(message, field, Checked(*field, value));
  }
}

void AddChoice(Message* message, const FieldDescriptor* field, const std::string& name) {
  const auto* value = schema::FindChoice(*field->enum_type(), name);
  if (value == nullptr) {
    throw CLI::ValidationError(field->name(), absl::StrCat("there is no \"", name, "\"; there are ",
                                                           schema::ChoiceNames(*field->enum_type())));
  }
  message->GetReflection()->AddEnum(message, field, value);
}

std::string Meaning(const FieldDescriptor& field) {
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    return absl::StrCat("comma-separated names (all) of ", schema::ChoiceNames(*field.enum_type()));
  }
  const v1::Quantity* quantity = schema::QuantityOf(field);
  if (quantity == nullptr) return "";
  std::string text = quantity->label().empty() ? absl::StrReplaceAll(field.name(), {{"_", " "}}) : quantity->label();
  absl::StrAppend(&text, ", ", schema::FormatRange(*quantity));
  if (field.is_repeated()) return absl::StrCat(text, ", comma-separated (none)");
  return absl::StrCat(text, " (", quantity->automatic() ? "automatic" : schema::FormatNumber(quantity->default_value()),
                      ")");
}

void AddOption(CLI::App& command, const std::string& name, const FieldDescriptor* field, Message* message) {
  const std::string meaning = Meaning(*field);
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_BOOL) {
    command.add_flag_callback(name, [=] { message->GetReflection()->SetBool(message, field, true); });
  } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    const auto set = [=](const std::vector<std::string>& values) {
      for (const std::string& value : values) AddChoice(message, field, value);
    };
    command.add_option_function<std::vector<std::string>>(name, set, meaning)->delimiter(',');
  } else if (field->is_repeated()) {
    const auto set = [=](const std::vector<double>& values) {
      for (const double value : values) message->GetReflection()->AddDouble(message, field, Checked(*field, value));
    };
    command.add_option_function<std::vector<double>>(name, set, meaning)->delimiter(',');
  } else {
    command.add_option_function<double>(
        name, [=](double value) { SetNumber(message, field, value); }, meaning);
  }
}

}  // namespace

void AddSchemaOptions(CLI::App& command, Message* message) {
  const auto& type = *message->GetDescriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    if (type.field(f)->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) continue;
    AddOption(command, "--" + absl::StrReplaceAll(type.field(f)->name(), {{"_", "-"}}), type.field(f), message);
  }
}

std::string FieldHelp(const google::protobuf::Descriptor& message, const std::string& field) {
  const v1::Quantity& quantity = *schema::QuantityOf(*message.FindFieldByName(field));
  const std::string otherwise = quantity.automatic() ? "automatic" : schema::FormatNumber(quantity.default_value());
  return absl::StrFormat("%s [%s], %s (%s). %s", quantity.label(), quantity.unit(), schema::FormatRange(quantity),
                         otherwise, quantity.help());
}

}  // namespace phrenic::client
