// From the words that were typed to the command that runs.
#ifndef PHRENIC_CLIENT_CLI_COMMAND_LINE_H_
#define PHRENIC_CLIENT_CLI_COMMAND_LINE_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>

#include "client/connection/connection.h"

namespace phrenic::client {

// Adds every command to the root. Parsing writes to what is given back, and sets `chosen` to run the command on it with
// the context as it is then; all four must outlive that.
std::shared_ptr<void> AddCommands(CLI::App& app, const Context& context, std::function<int()>& chosen);

// Parses the command line and runs the command; the exit code.
int RunCommandLine(int argc, char** argv, Interruption& interruption);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_COMMAND_LINE_H_
