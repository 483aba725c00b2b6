#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

void SetNumber(Message* message, const FieldDescriptor& field, double value) {
  const Reflection& reflection = *message->GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.SetDouble(message, &field, value);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return reflection.SetFloat(message, &field, static_cast<float>(value));
    case FieldDescriptor::CPPTYPE_INT32:
      return reflection.SetInt32(message, &field, static_cast<int32_t>(value));
    case FieldDescriptor::CPPTYPE_INT64:
      return reflection.SetInt64(message, &field, static_cast<int64_t>(value));
    case FieldDescriptor::CPPTYPE_UINT32:
      return reflection.SetUInt32(message, &field, static_cast<uint32_t>(value));
    case FieldDescriptor::CPPTYPE_UINT64:
      return reflection.SetUInt64(message, &field, static_cast<uint64_t>(value));
    default:
      return;  // only numbers have a Quantity; tests/schema checks that
  }
}

// Fields without presence are left unchanged: their 0 may be meant.
void FillField(Message* message, const FieldDescriptor& field) {
  if (field.is_repeated() || !field.has_presence() || message->GetReflection()->HasField(*message, &field)) return;
  const v1::Quantity* quantity = QuantityOf(field);
  if (quantity != nullptr && !quantity->automatic()) SetNumber(message, field, quantity->default_value());
  if (const v1::Toggle* toggle = ToggleOf(field)) {
    message->GetReflection()->SetBool(message, &field, toggle->default_value());
  }
  if (const v1::Choice* choice = ChoiceOf(field)) {
    message->GetReflection()->SetEnumValue(message, &field, choice->default_value());
  }
}

void FillNested(Message* message, const FieldDescriptor& field) {
  const Reflection& reflection = *message->GetReflection();
  if (!field.is_repeated()) {
    if (reflection.HasField(*message, &field)) FillDefaults(reflection.MutableMessage(message, &field));
    return;
  }
  for (int i = 0; i < reflection.FieldSize(*message, &field); ++i) {
    FillDefaults(reflection.MutableRepeatedMessage(message, &field, i));
  }
}

}  // namespace

void FillDefaults(Message* message) {
  for (int i = 0; i < message->GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor& field = *message->GetDescriptor()->field(i);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      FillNested(message, field);
    } else if (field.real_containing_oneof() == nullptr) {
      FillField(message, field);
    }
  }
}

}  // namespace phrenic::schema
