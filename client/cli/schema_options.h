// Command-line options made from a message's fields. Names, units, ranges and defaults come from the schema.
#ifndef PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_
#define PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/argument_kinds.h"
#include "server/schema/fields.h"

namespace phrenic::client {

// Adds one option per field, such as "--most-seconds-a-run" for most_seconds_a_run: a number, a comma-separated list of
// numbers or of choices by name, or a flag. Parsing writes to `message`. Requires: `message` outlives parsing.
void AddSchemaOptions(CLI::App& command, google::protobuf::Message* message);

// Returns the help text of a field: "Tolerance [mm], 1e-06 to 1000 mm (1). ...".
std::string FieldHelp(const google::protobuf::Descriptor& message, const std::string& field);

// Adds an option whose help and range are those of a field.
template <typename Value>
void AddNumber(CLI::App& command, const char* flag, Value& value, const google::protobuf::Descriptor& message,
               const char* field) {
  const v1::Quantity& quantity = *schema::QuantityOf(*message.FindFieldByName(field));
  command.add_option(flag, value, FieldHelp(message, field))->check(NumberIn(quantity.minimum(), quantity.maximum()));
}

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_
