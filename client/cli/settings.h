// Where this user's settings are kept.
#ifndef PHRENIC_CLIENT_CLI_SETTINGS_H_
#define PHRENIC_CLIENT_CLI_SETTINGS_H_

#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "server/settings/settings_file.h"

namespace phrenic::client {

// $PHRENIC_CONFIG, else $XDG_CONFIG_HOME/phrenic/config.toml, else that in ~/.config; empty where no home is known.
std::string SettingsFile();

// settings::ReadFile of it; a file that is not there says nothing, NOT_FOUND where PHRENIC_CONFIG names it.
absl::StatusOr<std::set<std::string>> ReadSettingsFile(const std::string& file, CLI::App& app);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SETTINGS_H_
