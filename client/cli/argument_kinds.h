// What the command line's arguments are, by their names: for help, for completion, and for what is checked here.
#ifndef PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_
#define PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace phrenic::client {

enum class Kind { kOther, kChoice, kFile, kFolder, kScene, kSession, kExport, kStudy, kPreset, kSetting };

struct ArgumentKind {
  Kind kind = Kind::kOther;
  std::string placeholder;           // "NAME=VALUE"; empty: from the type
  std::vector<std::string> choices;  // of kChoice
};

// Of one option or positional of a command.
ArgumentKind KindOf(const CLI::App& command, const CLI::Option& option);

// Gives every argument of the tree its placeholder, and every choice its check: one that is not there is refused with
// the nearest.
void ApplyKinds(CLI::App& command);

// Refuses what is no number, and what is outside.
CLI::Validator NumberIn(double low, double high);

// "--seconds" of "-s,--seconds", or a positional's name.
std::string NameOf(const CLI::Option& option);
// "run", "study error"; empty for the root.
std::string PathOf(const CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_ARGUMENT_KINDS_H_
