// Parses the command line and runs the command.
#ifndef PHRENIC_CLIENT_CLI_COMMAND_LINE_H_
#define PHRENIC_CLIENT_CLI_COMMAND_LINE_H_

#include <string>
#include <vector>

#include "client/cli/command.h"

namespace phrenic::client {

// Parses `words`, the arguments after the program's name, and runs one of the commands. Returns the exit code. Not
// thread-safe.
int RunCommandLine(const std::vector<std::string>& words, CommandTable commands, Interruption& interruption);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_COMMAND_LINE_H_
