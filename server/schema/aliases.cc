#include "server/schema/aliases.h"

#include "absl/strings/str_cat.h"
#include "phrenic/v1/options.pb.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::OneofDescriptor;
using google::protobuf::Reflection;

const std::string& NewName(const FieldDescriptor& field) { return field.options().GetExtension(v1::alias_of); }

bool IsSet(const Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  return field.is_repeated() ? reflection.FieldSize(message, &field) > 0 : reflection.HasField(message, &field);
}

std::optional<std::string> Clash(const Message& message, const FieldDescriptor& alias, const FieldDescriptor& target) {
  if (IsSet(message, target)) return absl::StrCat("is set twice, once as ", alias.name(), ": set it once");
  const OneofDescriptor* kind = target.real_containing_oneof();
  if (kind == nullptr || !message.GetReflection()->HasOneof(message, kind)) return std::nullopt;
  const FieldDescriptor* other = message.GetReflection()->GetOneofFieldDescriptor(message, kind);
  return absl::StrCat("is set together with ", other->name(), ": set one of them");
}

// Aliases are messages, enums and lists of text; tests/schema holds that.
void Move(Message* message, const FieldDescriptor& alias, const FieldDescriptor& target) {
  const Reflection& reflection = *message->GetReflection();
  if (alias.is_repeated()) {
    for (int i = 0; i < reflection.FieldSize(*message, &alias); ++i) {
      reflection.AddString(message, &target, reflection.GetRepeatedString(*message, &alias, i));
    }
  } else if (alias.cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
    reflection.SetEnumValue(message, &target, reflection.GetEnumValue(*message, &alias));
  } else {
    reflection.MutableMessage(message, &target)->CopyFrom(reflection.GetMessage(*message, &alias));
  }
  reflection.ClearField(message, &alias);
}

std::optional<Problem> MoveIn(Message* message, std::vector<PathStep>& path);

std::optional<Problem> MoveInNested(Message* message, const FieldDescriptor& field, std::vector<PathStep>& path) {
  const Reflection& reflection = *message->GetReflection();
  const int count = field.is_repeated() ? reflection.FieldSize(*message, &field) : 1;
  for (int i = 0; i < count; ++i) {
    path.push_back({&field, field.is_repeated() ? i : -1});
    std::optional<Problem> problem = MoveIn(field.is_repeated() ? reflection.MutableRepeatedMessage(message, &field, i)
                                                                : reflection.MutableMessage(message, &field),
                                            path);
    if (problem) return problem;
    path.pop_back();
  }
  return std::nullopt;
}

std::optional<Problem> MoveIn(Message* message, std::vector<PathStep>& path) {
  const auto& type = *message->GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& alias = *type.field(i);
    if (NewName(alias).empty() || !IsSet(*message, alias)) continue;
    const FieldDescriptor& target = *type.FindFieldByName(NewName(alias));
    if (auto clash = Clash(*message, alias, target)) {
      path.push_back({&target, -1});
      return Problem{path, *clash};
    }
    Move(message, alias, target);
  }
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE || !IsSet(*message, field)) continue;
    if (auto problem = MoveInNested(message, field, path)) return problem;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Problem> MoveAliases(Message* message) {
  std::vector<PathStep> path;
  return MoveIn(message, path);
}

std::vector<const FieldDescriptor*> AliasesOf(const FieldDescriptor& field) {
  std::vector<const FieldDescriptor*> aliases;
  for (int i = 0; i < field.containing_type()->field_count(); ++i) {
    const FieldDescriptor* other = field.containing_type()->field(i);
    if (NewName(*other) == field.name()) aliases.push_back(other);
  }
  return aliases;
}

}  // namespace phrenic::schema
