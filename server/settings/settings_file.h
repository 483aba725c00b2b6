// Settings of a program. Precedence: command line, environment, settings file, default. Every command-line option is a
// setting of the same name.
#ifndef PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_
#define PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_

#include <CLI/CLI.hpp>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/settings/setting.h"

namespace phrenic::settings {

// Reads a TOML file and makes its values the defaults of the options of `app` and its subcommands; an option with a
// delimiter takes an array. Call it before the command line is parsed. Returns the names of the settings in the file
// that belong to no subcommand. INVALID_ARGUMENT "FILE:LINE: ..." for an unknown setting or a bad value. Not
// thread-safe, as CLI11 is not.
absl::StatusOr<std::set<std::string>> ReadFile(const std::string& file, CLI::App& app);

// Returns the settings of a parsed root command with their origins, without flags that take no value. `words` is the
// command line; `in_file` is the result of ReadFile.
std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words, const std::string& file,
                                const std::set<std::string>& in_file);

}  // namespace phrenic::settings

#endif  // PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_
