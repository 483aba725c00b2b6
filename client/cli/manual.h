// The manual page phrenic(1), made from the same tables as the help.
#ifndef PHRENIC_CLIENT_CLI_MANUAL_H_
#define PHRENIC_CLIENT_CLI_MANUAL_H_

#include <CLI/CLI.hpp>
#include <string>

#include "client/cli/command.h"

namespace phrenic::client {

// Returns the manual page in the macros of man(7), for `man -l` and mandoc. `root` holds the commands of the table.
std::string ManualOf(const CLI::App& root, CommandTable commands);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_MANUAL_H_
