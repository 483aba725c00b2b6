// The parts of the help that belong to no single command: first examples, exit codes, environment, settings, and words
// that users type for commands of another name.
#ifndef PHRENIC_CLIENT_CLI_GUIDE_H_
#define PHRENIC_CLIENT_CLI_GUIDE_H_

#include <span>
#include <string>
#include <string_view>

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

// Returns the command that a user means by a word: "sessions" for "ls"; empty if the word is not known.
std::string CommandMeantBy(std::string_view word);
// The same for a word that is nearly one of these, such as "lern" for "learn".
std::string CommandNearlyMeantBy(std::string_view word);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_GUIDE_H_
