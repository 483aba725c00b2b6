// Errors of the command line, with the command to type instead.
#ifndef PHRENIC_CLIENT_CLI_USAGE_ERROR_H_
#define PHRENIC_CLIENT_CLI_USAGE_ERROR_H_

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/command.h"

namespace phrenic::client {

// Returns the error as lines for standard error; the last lines are commands to type. `root` is the app that threw the
// error.
std::string Explain(const CLI::App& root, CommandTable commands, const CLI::ParseError& error);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_USAGE_ERROR_H_
