// Where settings come from: the command line, else the environment, else the settings file, else the default.
#ifndef PHRENIC_CLIENT_SETTINGS_H_
#define PHRENIC_CLIENT_SETTINGS_H_

#include <CLI/CLI.hpp>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection.h"

namespace phrenic::client {

// $PHRENIC_CONFIG, else $XDG_CONFIG_HOME/phrenic/config.toml, else that in ~/.config; empty where no home is known.
std::string SettingsFile();

// Makes the file's values the defaults of the tree's options; a file that is not there says nothing. To be called
// before the command line is parsed. Gives the settings of every command that the file has; INVALID_ARGUMENT
// "FILE:LINE: ..." names the setting and those there are.
absl::StatusOr<std::set<std::string>> ReadSettingsFile(const std::string& file, CLI::App& app);

// Of the parsed root; `in_file` as ReadSettingsFile gave it.
std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words,
                                const std::set<std::string>& in_file);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_SETTINGS_H_
