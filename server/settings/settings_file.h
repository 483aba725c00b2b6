// A program's settings: the command line before the environment, that before a file, that before the default. Each
// option of the command line is a setting of the same name.
#ifndef PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_
#define PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_

#include <CLI/CLI.hpp>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/settings/setting.h"

namespace phrenic::settings {

// Makes the values of a TOML file the defaults of the tree's options; an option with a delimiter takes an array. To be
// called before the command line is parsed. Gives the settings of every command that the file has; INVALID_ARGUMENT
// "FILE:LINE: ..." names the setting and those there are. Not thread-safe, as CLI11.
absl::StatusOr<std::set<std::string>> ReadFile(const std::string& file, CLI::App& app);

// Of the parsed root, without flags that have no value; `in_file` as ReadFile gave it.
std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words, const std::string& file,
                                const std::set<std::string>& in_file);

}  // namespace phrenic::settings

#endif  // PHRENIC_SERVER_SETTINGS_SETTINGS_FILE_H_
