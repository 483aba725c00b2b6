// What phrenicd does besides serving: each gives the exit code.
#ifndef PHRENIC_SERVER_DAEMON_COMMANDS_H_
#define PHRENIC_SERVER_DAEMON_COMMANDS_H_

#include <CLI/CLI.hpp>
#include <functional>

#include "server/daemon/flags.h"

namespace phrenic::daemon {

// Adds check, config and token to the app; parsing it sets `chosen` where one of them is typed. `flags` and `chosen`
// outlive the app.
void AddCommands(CLI::App& app, Flags& flags, std::function<int()>& chosen);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_COMMANDS_H_
