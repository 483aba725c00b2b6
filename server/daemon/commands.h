// The commands of phrenicd other than serving. Each returns the exit code.
#ifndef PHRENIC_SERVER_DAEMON_COMMANDS_H_
#define PHRENIC_SERVER_DAEMON_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <functional>

#include "server/daemon/flags.h"

namespace phrenic::daemon {

// Adds the commands check and token to `app`. Parsing sets `chosen` to the function of the command that is named; it
// stays empty if there is none. `flags` and `chosen` outlive the app.
void AddCommands(CLI::App& app, Flags& flags, std::function<int()>& chosen);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_COMMANDS_H_
