// Where settings come from: the command line, else the environment, else the settings file, else the default.
#ifndef PHRENIC_CLIENT_SETTINGS_H_
#define PHRENIC_CLIENT_SETTINGS_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/connection.h"

namespace phrenic::client {

// $PHRENIC_CONFIG, else $XDG_CONFIG_HOME/phrenic/config.toml, else that in ~/.config; empty where no home is known.
std::string SettingsFile();

// Makes the file's values the defaults of the tree's options; a file that is not there says nothing. To be called
// before the command line is parsed. INVALID_ARGUMENT "FILE:LINE: ..." names the setting and those there are.
absl::Status ReadSettingsFile(const std::string& file, CLI::App& app);

// Of the parsed root.
std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_SETTINGS_H_
