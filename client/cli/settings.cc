#include "client/cli/settings.h"

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "client/terminal/environment.h"

namespace phrenic::client {

std::string SettingsFile() {
  if (std::string file = EnvironmentVariable("PHRENIC_CONFIG"); !file.empty()) return file;
  std::string folder = EnvironmentVariable("XDG_CONFIG_HOME");
  if (const std::string home = EnvironmentVariable("HOME"); folder.empty() && !home.empty()) folder = home + "/.config";
  return folder.empty() ? "" : folder + "/phrenic/config.toml";
}

absl::StatusOr<std::set<std::string>> ReadSettingsFile(const std::string& file, CLI::App& app) {
  std::error_code error;
  if (!file.empty() && std::filesystem::exists(file, error)) return settings::ReadFile(file, app);
  if (EnvironmentVariable("PHRENIC_CONFIG").empty()) return std::set<std::string>();
  return absl::NotFoundError(absl::StrCat("PHRENIC_CONFIG: there is no file ", file));
}

}  // namespace phrenic::client
