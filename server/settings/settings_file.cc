#include "server/settings/settings_file.h"

#include <fstream>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/schema/names.h"

namespace phrenic::settings {
namespace {

constexpr char kSectionBegins[] = "++", kSectionEnds[] = "--";  // CLI11's names for the start and end of a section

// Returns the first line in the item's section that begins with its name, because CLI11 reports no line numbers.
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

// Returns the item's command; null if there is none.
CLI::App* CommandOf(CLI::App& app, const CLI::ConfigItem& item) {
  CLI::App* command = &app;
  for (const std::string& name : item.parents) {
    const auto found = command->get_subcommands([&](const CLI::App* each) { return each->get_name() == name; });
    if (found.empty()) return nullptr;
    command = found.front();
  }
  return command;
}

std::string LongName(const CLI::Option& option) {
  return option.get_lnames().empty() ? "" : option.get_lnames().front();
}

// Returns the options with a long name, except --help and --version.
std::vector<const CLI::Option*> OptionsOf(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) {
    const std::string name = LongName(*option);
    return !name.empty() && name != "help" && name != "version";
  });
}

absl::Status SetDefault(CLI::Option& option, const CLI::ConfigItem& item) {
  const bool list = option.get_delimiter() != '\0';
  if (!list && (item.inputs.size() != 1 || option.get_expected_max() > 1)) {
    return absl::InvalidArgumentError(absl::StrCat(item.name, " takes several values: set it on the command line"));
  }
  const std::string value = absl::StrJoin(item.inputs, ",");
  if (list && value.empty()) return absl::OkStatus();
  try {
    option.run_callback_for_default()->default_val(value);
  } catch (const CLI::Error& error) {
    return absl::InvalidArgumentError(error.what());
  }
  return absl::OkStatus();
}

absl::Status Apply(const CLI::ConfigItem& item, CLI::App& app) {
  CLI::App* command = CommandOf(app, item);
  if (command == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat("there is no command [", absl::StrJoin(item.parents, "."), "]"));
  }
  if (item.name == kSectionBegins || item.name == kSectionEnds) return absl::OkStatus();
  CLI::Option* option = command->get_option_no_throw("--" + item.name);
  if (option != nullptr) return SetDefault(*option, item);
  std::vector<std::string> names;
  for (const CLI::Option* each : OptionsOf(*command)) names.push_back(LongName(*each));
  return absl::InvalidArgumentError(
      absl::StrCat("there is no setting \"", item.name, "\"", schema::ThereAre(item.name, names)));
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

}  // namespace

absl::StatusOr<std::set<std::string>> ReadFile(const std::string& file, CLI::App& app) {
  std::vector<CLI::ConfigItem> items;
  try {
    items = CLI::ConfigTOML().from_file(file);
  } catch (const CLI::Error& error) {
    return absl::InvalidArgumentError(absl::StrCat(file, ": is not valid TOML: ", error.what()));
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

std::vector<Setting> SettingsOf(const CLI::App& app, const std::vector<std::string>& words, const std::string& file,
                                const std::set<std::string>& in_file) {
  std::vector<Setting> settings;
  for (const CLI::Option* option : OptionsOf(app)) {
    if (option->get_items_expected_max() == 0 && option->get_envname().empty()) continue;
    const std::string name = LongName(*option);
    const bool given = option->count() > 0;
    const std::string value = given ? absl::StrJoin(option->results(), ",") : option->get_default_str();
    const std::string origin = IsNamedBy(*option, words) ? "--" + name
                               : given                   ? option->get_envname()
                               : in_file.contains(name)  ? file
                                                         : "default";
    settings.push_back({name, value, origin});
  }
  return settings;
}

}  // namespace phrenic::settings
