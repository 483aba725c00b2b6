// Older names of fields (option alias_of of phrenic/v1/options.proto).
#ifndef PHRENIC_SERVER_SCHEMA_ALIASES_H_
#define PHRENIC_SERVER_SCHEMA_ALIASES_H_

#include <google/protobuf/message.h>

#include <optional>

#include "server/schema/problem.h"

namespace phrenic::schema {

// Moves every value under an older name to the field of the new name, through all nested messages. Returns a problem if
// a message sets both names, or the older name beside another member of the new name's oneof.
std::optional<Problem> MoveAliases(google::protobuf::Message* message);

// The fields of the message type that are older names of `field`.
std::vector<const google::protobuf::FieldDescriptor*> AliasesOf(const google::protobuf::FieldDescriptor& field);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_ALIASES_H_
