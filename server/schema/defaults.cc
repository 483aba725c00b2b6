#include <google/protobuf/descriptor.h>

#include "phrenic/v1/options.pb.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

void FillNumber(const FieldDescriptor& field, Message* message) {
  const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
  if (quantity.automatic()) return;
  const google::protobuf::Reflection& reflection = *message->GetReflection();
  const double value = quantity.default_value();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.SetDouble(message, &field, value);
    case FieldDescriptor::CPPTYPE_INT32:
      return reflection.SetInt32(message, &field, static_cast<int>(value));
    case FieldDescriptor::CPPTYPE_INT64:
      return reflection.SetInt64(message, &field, static_cast<std::int64_t>(value));
    default:
      return;
  }
}

void FillNested(const FieldDescriptor& field, Message* message) {
  const google::protobuf::Reflection& reflection = *message->GetReflection();
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
  const google::protobuf::Descriptor& type = *message->GetDescriptor();
  const google::protobuf::Reflection& reflection = *message->GetReflection();
  for (int f = 0; f < type.field_count(); ++f) {
    const FieldDescriptor& field = *type.field(f);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      FillNested(field, message);
      continue;
    }
    if (field.is_repeated() || !field.has_presence() || reflection.HasField(*message, &field)) continue;
    if (field.options().HasExtension(v1::quantity)) FillNumber(field, message);
    if (field.options().HasExtension(v1::toggle)) {
      reflection.SetBool(message, &field, field.options().GetExtension(v1::toggle).default_value());
    }
  }
}

}  // namespace phrenic::schema
