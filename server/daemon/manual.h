// Settings in words: those that hold, a file of them all, the manual page.
#ifndef PHRENIC_SERVER_DAEMON_MANUAL_H_
#define PHRENIC_SERVER_DAEMON_MANUAL_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "server/settings/setting.h"

namespace phrenic::daemon {

// "name = value  # origin" a line, which is a settings file again.
std::string Describe(const std::vector<settings::Setting>& settings);
// A settings file with every setting, what it means and its default, each commented out.
std::string Template(const CLI::App& app);
// For `man`: every setting and command.
std::string ManualOf(const CLI::App& app);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_MANUAL_H_
