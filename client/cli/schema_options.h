// Command-line options made from the fields of a message: names, units, ranges and defaults are the schema's.
#ifndef PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_
#define PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_

#include <google/protobuf/message.h>

#include <CLI/CLI.hpp>

namespace phrenic::client {

// One option a field, "--most-seconds-a-run" for most_seconds_a_run: numbers, lists of numbers with commas, switches
// (flags), lists of choices by name. `message` is written to while the command line is parsed and must outlive that.
void AddSchemaOptions(CLI::App* command, google::protobuf::Message* message);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SCHEMA_OPTIONS_H_
