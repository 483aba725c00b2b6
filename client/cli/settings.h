// The user's settings file.
#ifndef PHRENIC_CLIENT_CLI_SETTINGS_H_
#define PHRENIC_CLIENT_CLI_SETTINGS_H_

#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "server/settings/settings_file.h"

namespace phrenic::client {

// Returns $PHRENIC_CONFIG, or $XDG_CONFIG_HOME/phrenic/config.toml, or ~/.config/phrenic/config.toml: the first whose
// variable is set; empty if none is.
std::string SettingsFile();

// Makes the file's values the defaults of the tree's options. Returns the names that the file sets
// (settings::ReadFile); empty if there is no file. NOT_FOUND if PHRENIC_CONFIG names a missing file; INVALID_ARGUMENT
// names file and line. Requires: called before parsing.
absl::StatusOr<std::set<std::string>> ReadSettingsFile(const std::string& file, CLI::App& app);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SETTINGS_H_
