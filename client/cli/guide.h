// The words of the manual that belong to no single option: groups and examples of the commands, exit codes,
// environment. Help, man page and errors are made from them.
#ifndef PHRENIC_CLIENT_CLI_GUIDE_H_
#define PHRENIC_CLIENT_CLI_GUIDE_H_

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace phrenic::client {

struct Example {
  const char* line;     // as it is typed
  const char* meaning;  // may be empty
};

struct CommandGuide {
  const char* command;  // "run", "study error"
  const char* group;    // in the list of commands; empty below another command
  std::vector<Example> examples;
};

struct Named {
  const char* name;
  const char* meaning;
};

// One for every command, in the order in which they are listed.
std::span<const CommandGuide> Guides();
// Null where there is none.
const CommandGuide* GuideOf(std::string_view command);

std::span<const Example> FirstExamples();
std::span<const Named> ExitCodes();
std::span<const Named> EnvironmentVariables();
// Where settings come from, the strongest first, and what stands in the file.
std::string SettingsText();

// What people type for a command that has another name: "sessions" for "ls"; empty where nothing is known.
std::string CommandMeantBy(std::string_view word);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_GUIDE_H_
