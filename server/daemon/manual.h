// Texts about the settings: the values in use, a template file, the manual page. Pure functions.
#ifndef PHRENIC_SERVER_DAEMON_MANUAL_H_
#define PHRENIC_SERVER_DAEMON_MANUAL_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "server/settings/setting.h"

namespace phrenic::daemon {

// Returns one line "name = value  # origin" per setting. The text is a valid settings file.
std::string Describe(const std::vector<settings::Setting>& settings);
// Returns a settings file with the meaning and the default of every setting, all commented out.
std::string Template(const CLI::App& app);
// Returns the manual page in roff (man(7)), with all settings and commands.
std::string ManualOf(const CLI::App& app);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_MANUAL_H_
