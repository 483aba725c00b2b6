// The kinds of the command line's arguments, by their names. Help, completion and checks are made from them.
#ifndef PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_
#define PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace phrenic::client {

enum class Kind { kOther, kChoice, kFile, kFolder, kScene, kSession, kExport, kStudy, kPreset, kSetting, kPhysique };

struct ArgumentKind {
  Kind kind = Kind::kOther;
  std::string placeholder;           // "NAME=VALUE"; empty: CLI11's name of the type
  std::vector<std::string> choices;  // of kChoice
};

// Returns the kind of an option or positional argument of a command.
ArgumentKind KindOf(const CLI::App& command, const CLI::Option& option);

// Sets the placeholder of every argument of the tree, and a check for every choice and every setting: an unknown choice
// is an error that names the nearest one.
void ApplyKinds(CLI::App& command);

// Throws CLI::ValidationError if an option of the commands that were typed gives one name two values, as in
// "--set breath_force=1 --set breath_force=2". Requires: `command` was parsed.
void CheckNamesOnce(const CLI::App& command);

// Returns a check for numbers in [low, high].
CLI::Validator NumberIn(double low, double high);
// Returns a check for texts that `parse` accepts; its message becomes an error of usage.
CLI::Validator ParsedBy(std::function<absl::Status(const std::string&)> parse);

// Returns the option's long name, such as "--seconds", or the positional argument's name.
std::string NameOf(const CLI::Option& option);
// Returns the command's path, such as "run" or "study error"; empty for the root.
std::string PathOf(const CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_
