#include <google/protobuf/descriptor.h>

#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/schema/describe.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

absl::Status Invalid(const std::string& path, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", what));
}

double Number(const Message& message, const Reflection& reflection, const FieldDescriptor& field, int index) {
  const bool repeated = field.is_repeated();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return repeated ? reflection.GetRepeatedDouble(message, &field, index) : reflection.GetDouble(message, &field);
    case FieldDescriptor::CPPTYPE_INT32:
      return repeated ? reflection.GetRepeatedInt32(message, &field, index) : reflection.GetInt32(message, &field);
    case FieldDescriptor::CPPTYPE_INT64:
      return static_cast<double>(repeated ? reflection.GetRepeatedInt64(message, &field, index)
                                          : reflection.GetInt64(message, &field));
    default:
      return 0;
  }
}

absl::Status CheckNumber(double value, const FieldDescriptor& field, const std::string& path) {
  if (!std::isfinite(value)) return Invalid(path, "is not a finite number");
  if (!field.options().HasExtension(v1::quantity)) return absl::OkStatus();
  const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
  if (value >= quantity.minimum() && value <= quantity.maximum()) return absl::OkStatus();
  return Invalid(path, absl::StrCat(value, " is outside ", Range(quantity)));
}

absl::Status CheckEnum(const FieldDescriptor& field, int value, const std::string& path) {
  if (field.enum_type()->FindValueByNumber(value) != nullptr) return absl::OkStatus();
  return Invalid(path, absl::StrCat(value, " is no value of ", std::string(field.enum_type()->name())));
}

absl::Status Check(const Message& message, const std::string& prefix);

absl::Status CheckValue(const Message& message, const FieldDescriptor& field, int index, const std::string& path) {
  const Reflection& reflection = *message.GetReflection();
  const bool repeated = field.is_repeated();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return Check(
          repeated ? reflection.GetRepeatedMessage(message, &field, index) : reflection.GetMessage(message, &field),
          path + ".");
    case FieldDescriptor::CPPTYPE_ENUM:
      return CheckEnum(
          field,
          repeated ? reflection.GetRepeatedEnumValue(message, &field, index) : reflection.GetEnumValue(message, &field),
          path);
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_INT64:
      return CheckNumber(Number(message, reflection, field, index), field, path);
    default:
      return absl::OkStatus();
  }
}

bool Missing(const Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  return field.is_repeated() ? reflection.FieldSize(message, &field) == 0 : !reflection.HasField(message, &field);
}

// A number without presence whose range leaves out 0 was forgotten: the check sees the 0.
bool ToBeChecked(const Message& message, const FieldDescriptor& field) {
  const bool number = field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE;
  return !Missing(message, field) || (number && !field.has_presence() && !field.is_repeated());
}

absl::Status CheckField(const Message& message, const FieldDescriptor& field, const std::string& path) {
  if (Missing(message, field) && field.options().GetExtension(v1::required)) {
    return Invalid(path, "is missing; it must be set");
  }
  if (!ToBeChecked(message, field)) return absl::OkStatus();
  if (!field.is_repeated()) return CheckValue(message, field, 0, path);
  for (int i = 0; i < message.GetReflection()->FieldSize(message, &field); ++i) {
    absl::Status status = CheckValue(message, field, i, absl::StrCat(path, "[", i, "]"));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status Check(const Message& message, const std::string& prefix) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    absl::Status status = CheckField(message, *type.field(f), prefix + std::string(type.field(f)->name()));
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status Validate(const Message& message) { return Check(message, ""); }

}  // namespace phrenic::schema
