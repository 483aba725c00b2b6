#include <google/protobuf/stubs/common.h>

#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/schema/aliases.h"
#include "server/schema/fields.h"
#include "server/schema/problem.h"
#include "server/schema/repetition.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

std::string NamesOf(const EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.value_count(); ++i) {
    const google::protobuf::EnumValueDescriptor* value = type.value(i);
    const bool older_name = type.FindValueByNumber(value->number()) != value;
    if (value->number() != 0 && !older_name) names.push_back(value->name());
  }
  return absl::StrJoin(names, ", ");
}

// By protobuf's own check (RFC 3629), so that no message is refused when it is parsed from its bytes.
bool IsUtf8(const std::string& text) { return google::protobuf::internal::IsStructurallyValidUTF8(text); }

// A value of a field: entry `index` of a repeated field, or the field's own if `index` is -1.
class Value {
 public:
  Value(const Message& message, const FieldDescriptor& field, int index)
      : message_(message), reflection_(*message.GetReflection()), field_(field), index_(index) {}

  std::optional<std::string> Problem() const {
    switch (field_.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return Number(Get(&Reflection::GetDouble, &Reflection::GetRepeatedDouble));
      case FieldDescriptor::CPPTYPE_FLOAT:
        return Number(Get(&Reflection::GetFloat, &Reflection::GetRepeatedFloat));
      case FieldDescriptor::CPPTYPE_INT32:
        return Number(Get(&Reflection::GetInt32, &Reflection::GetRepeatedInt32));
      case FieldDescriptor::CPPTYPE_INT64:
        return Number(Get(&Reflection::GetInt64, &Reflection::GetRepeatedInt64));
      case FieldDescriptor::CPPTYPE_UINT32:
        return Number(Get(&Reflection::GetUInt32, &Reflection::GetRepeatedUInt32));
      case FieldDescriptor::CPPTYPE_UINT64:
        return Number(Get(&Reflection::GetUInt64, &Reflection::GetRepeatedUInt64));
      case FieldDescriptor::CPPTYPE_ENUM:
        return Enum(Get(&Reflection::GetEnumValue, &Reflection::GetRepeatedEnumValue));
      case FieldDescriptor::CPPTYPE_STRING:
        return Text(Get(&Reflection::GetString, &Reflection::GetRepeatedString));
      case FieldDescriptor::CPPTYPE_BOOL:
      case FieldDescriptor::CPPTYPE_MESSAGE:
        return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  template <typename T>
  T Get(T (Reflection::*one)(const Message&, const FieldDescriptor*) const,
        T (Reflection::*of_many)(const Message&, const FieldDescriptor*, int) const) const {
    return index_ < 0 ? (reflection_.*one)(message_, &field_) : (reflection_.*of_many)(message_, &field_, index_);
  }

  template <typename T>
  std::optional<std::string> Number(T value) const {
    return NumberProblem(static_cast<double>(value), QuantityOf(field_));
  }

  std::optional<std::string> Enum(int value) const {
    if (field_.enum_type()->FindValueByNumber(value) != nullptr) return std::nullopt;
    return absl::StrCat(value, " is not one of ", NamesOf(*field_.enum_type()));
  }

  std::optional<std::string> Text(const std::string& value) const {
    if (field_.type() == FieldDescriptor::TYPE_BYTES || IsUtf8(value)) return std::nullopt;
    return "the text is not UTF-8; save the file in that encoding";
  }

  const Message& message_;
  const Reflection& reflection_;
  const FieldDescriptor& field_;
  int index_;
};

bool IsEmpty(const Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  if (field.is_repeated()) return reflection.FieldSize(message, &field) == 0;
  if (!reflection.HasField(message, &field)) return true;
  return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING && reflection.GetString(message, &field).empty();
}

std::string MissingProblem(const FieldDescriptor& field) {
  const std::string owner = field.containing_type()->name();
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    return absl::StrCat("must be set: every ", owner, " needs one of ", NamesOf(*field.enum_type()));
  }
  if (field.is_repeated()) return absl::StrCat("must not be empty: every ", owner, " needs at least one");
  return absl::StrCat("must be set: every ", owner, " needs it");
}

std::optional<Problem> FindIn(const Message& message, std::vector<PathStep>& path);

std::optional<Problem> FindInValue(const Message& message, const FieldDescriptor& field, int index,
                                   std::vector<PathStep>& path) {
  path.push_back({&field, index});
  std::optional<Problem> problem;
  if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    const Reflection& reflection = *message.GetReflection();
    problem = FindIn(
        index < 0 ? reflection.GetMessage(message, &field) : reflection.GetRepeatedMessage(message, &field, index),
        path);
  } else if (std::optional<std::string> what = Value(message, field, index).Problem()) {
    problem = Problem{path, *what};
  }
  path.pop_back();
  return problem;
}

std::optional<Problem> FindInField(const Message& message, const FieldDescriptor& field, std::vector<PathStep>& path) {
  if (IsRequired(field) && IsEmpty(message, field)) {
    path.push_back({&field, -1});
    return Problem{path, MissingProblem(field)};
  }
  if (!field.is_repeated()) {
    // A number without presence is always checked: unset, it is 0, which may be outside its range.
    const bool counts = !field.has_presence() || message.GetReflection()->HasField(message, &field);
    return counts ? FindInValue(message, field, -1, path) : std::nullopt;
  }
  const int size = message.GetReflection()->FieldSize(message, &field);
  for (int index = 0; index < size; ++index) {
    if (auto problem = FindInValue(message, field, index, path)) return problem;
  }
  return std::nullopt;
}

std::optional<Problem> FindIn(const Message& message, std::vector<PathStep>& path) {
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    if (auto problem = FindInField(message, *message.GetDescriptor()->field(i), path)) return problem;
  }
  return std::nullopt;
}

absl::Status ErrorOf(const Problem& problem) {
  return absl::InvalidArgumentError(absl::StrCat(FormatPath(problem.path), ": ", problem.what));
}

}  // namespace

std::optional<Problem> FindProblem(const Message& message) {
  std::vector<PathStep> path;
  return FindIn(message, path);
}

std::string FormatPath(const std::vector<PathStep>& path) {
  return absl::StrJoin(path, ".", [](std::string* out, const PathStep& step) {
    absl::StrAppend(out, step.field->name());
    if (step.index >= 0) absl::StrAppend(out, "[", step.index, "]");
  });
}

absl::Status Validate(const Message& message) {
  const std::optional<Problem> problem = FindProblem(message);
  return problem ? ErrorOf(*problem) : absl::OkStatus();
}

absl::Status Resolve(v1::Scene* scene) {
  if (const auto problem = MoveAliases(scene)) return ErrorOf(*problem);
  if (const auto problem = FindProblem(*scene)) return ErrorOf(*problem);
  if (const auto problem = Repeat(scene)) return ErrorOf(*problem);
  return absl::OkStatus();
}

}  // namespace phrenic::schema
