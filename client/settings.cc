#include "client/settings.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/argument_kinds.h"
#include "client/help.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

constexpr char kSectionBegins[] = "++", kSectionEnds[] = "--";  // CLI11's names of what is no setting

std::string Environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// CLI11 tells no lines: the first one that begins with the name, below its command's.
int LineOf(const std::string& file, const CLI::ConfigItem& item) {
  std::ifstream in(file);
  const std::string section = "[" + absl::StrJoin(item.parents, ".") + "]";
  bool inside = item.parents.empty();
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    absl::StripAsciiWhitespace(&line);
    if (absl::StartsWith(line, "[")) inside = line == section;
    if (inside && item.name == kSectionBegins) return number;
    if (inside && absl::StartsWith(line, item.name)) return number;
  }
  return 1;
}

// Null where there is none.
CLI::App* CommandOf(CLI::App& app, const CLI::ConfigItem& item) {
  CLI::App* command = &app;
  for (const std::string& name : item.parents) {
    const auto below = command->get_subcommands([&](const CLI::App* one) { return one->get_name() == name; });
    if (below.empty()) return nullptr;
    command = below.front();
  }
  return command;
}

std::vector<std::string> SettingNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : OptionsOf(command)) names.push_back(NameOf(*option).substr(2));
  return names;
}

absl::Status Apply(const CLI::ConfigItem& item, CLI::App& app) {
  CLI::App* command = CommandOf(app, item);
  if (command == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat("there is no command [", absl::StrJoin(item.parents, "."), "]"));
  }
  if (item.name == kSectionBegins || item.name == kSectionEnds) return absl::OkStatus();
  CLI::Option* option = command->get_option_no_throw("--" + item.name);
  if (option == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat("there is no setting \"", item.name, "\"", schema::ThereAre(item.name, SettingNames(*command))));
  }
  if (item.inputs.size() != 1 || option->get_expected_max() > 1) {
    return absl::InvalidArgumentError(absl::StrCat(item.name, " takes several values: give it on the command line"));
  }
  try {
    option->run_callback_for_default()->default_val(item.inputs.front());
  } catch (const CLI::Error& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return absl::OkStatus();
}

bool IsNamedBy(const CLI::Option& option, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    for (const std::string& name : option.get_lnames()) {
      if (word == "--" + name || absl::StartsWith(word, absl::StrCat("--", name, "="))) return true;
    }
    for (const std::string& name : option.get_snames()) {
      if (absl::StartsWith(word, "-" + name)) return true;
    }
  }
  return false;
}

std::string OriginOf(const CLI::Option& option, const std::vector<std::string>& words,
                     const std::set<std::string>& in_file) {
  if (IsNamedBy(option, words)) return NameOf(option);
  if (option.count() > 0) return option.get_envname();
  return in_file.contains(NameOf(option).substr(2)) ? SettingsFile() : "default";
}

}  // namespace

std::string SettingsFile() {
  if (std::string file = Environment("PHRENIC_CONFIG"); !file.empty()) return file;
  std::string folder = Environment("XDG_CONFIG_HOME");
  if (const std::string home = Environment("HOME"); folder.empty() && !home.empty()) folder = home + "/.config";
  return folder.empty() ? "" : folder + "/phrenic/config.toml";
}

absl::StatusOr<std::set<std::string>> ReadSettingsFile(const std::string& file, CLI::App& app) {
  std::error_code error;
  if (file.empty() || !std::filesystem::exists(file, error)) {
    if (Environment("PHRENIC_CONFIG").empty()) return std::set<std::string>();
    return absl::NotFoundError(absl::StrCat("PHRENIC_CONFIG: there is no file ", file));
  }
  std::vector<CLI::ConfigItem> items;
  try {
    items = CLI::ConfigTOML().from_file(file);
  } catch (const CLI::Error& fault) {
    return absl::InvalidArgumentError(absl::StrCat(file, ": cannot be read as TOML: ", fault.what()));
  }
  std::set<std::string> names;
  for (const CLI::ConfigItem& item : items) {
    if (item.parents.empty()) names.insert(item.name);
    if (const absl::Status status = Apply(item, app); !status.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(file, ":", LineOf(file, item), ": ", status.message()));
    }
  }
  return names;
}

std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words,
                                const std::set<std::string>& in_file) {
  std::vector<Setting> settings;
  for (const CLI::Option* option : OptionsOf(app)) {
    if (option->get_items_expected_max() == 0) continue;
    const std::string value = option->count() > 0 ? option->as<std::string>() : option->get_default_str();
    settings.push_back({NameOf(*option).substr(2), value, OriginOf(*option, words, in_file)});
  }
  return settings;
}

}  // namespace phrenic::client
