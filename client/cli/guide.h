// The parts of the help that belong to no single command: first examples, exit codes, environment, settings, and words
// that users type for commands of another name.
#ifndef PHRENIC_CLIENT_CLI_GUIDE_H_
#define PHRENIC_CLIENT_CLI_GUIDE_H_

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/cli/command.h"

namespace phrenic::client {

struct NamedText {
  const char* name;
  const char* meaning;
};

std::span<const Example> FirstExamples();
std::span<const NamedText> ExitCodes();
std::span<const NamedText> EnvironmentVariables();
// Returns the precedence of settings and the format of the settings file.
std::string SettingsText();

// Returns what a user means by a word that `commands` does not have: "sessions" for "ls", "run" for "rnu", "--help" for
// "lern". Empty if the word is near none of them and of the words that users type for them.
std::string CommandMeantBy(std::string_view word, std::vector<std::string> commands);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_GUIDE_H_
