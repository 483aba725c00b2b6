#include "server/daemon/manual.h"

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic::daemon {
namespace {

std::vector<const CLI::Option*> Settings(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) {
    return !option->get_lnames().empty() && !option->get_envname().empty() && option->get_lnames().front() != "config";
  });
}

// Replaces absolute paths, which vary by machine.
std::string WithoutPath(const std::string& value) { return absl::StartsWith(value, "/") ? "/..." : value; }

bool IsNumber(const std::string& value) {
  double number = 0;
  return value == "true" || value == "false" || CLI::detail::lexical_cast(value, number);
}

std::string Toml(const std::string& value) {
  if (value == "[]") return "\"\"";  // CLI11's text for an empty list
  if (IsNumber(value)) return value;
  return "\"" + absl::StrReplaceAll(value, {{"\\", "\\\\"}, {"\"", "\\\""}}) + "\"";
}

std::string Escaped(const std::string& text) { return absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}}); }

std::string Item(const std::string& label, const std::string& meaning) {
  return absl::StrCat(".TP\n.B ", Escaped(label), "\n", Escaped(meaning), "\n");
}

std::string CommandItems(const CLI::App& app, const std::string& before) {
  std::string text;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string name = absl::StrCat(before, " ", command->get_name());
    absl::StrAppend(&text, Item(name, command->get_description()), CommandItems(*command, name));
  }
  return text;
}

}  // namespace

std::string Describe(const std::vector<settings::Setting>& settings) {
  std::string text;
  for (const settings::Setting& setting : settings) {
    if (setting.name == "config") continue;
    std::string line = absl::StrCat(setting.name, " = ", Toml(setting.value));
    constexpr std::size_t kColumn = 48;
    line.resize(std::max(line.size() + 1, kColumn), ' ');
    absl::StrAppend(&text, line, "# ", setting.origin, "\n");
  }
  return text;
}

std::string Template(const CLI::App& app) {
  std::string text =
      "# Settings of phrenicd. Precedence: flags, environment variables (PHRENICD_MAX_SESSIONS), this file, defaults.\n"
      "# \"phrenicd config\" prints the settings in use and their origins. Each line below is a default.\n";
  std::string group;
  for (const CLI::Option* option : Settings(app)) {
    if (option->get_group() != group) absl::StrAppend(&text, "\n# --- ", group = option->get_group(), " ---\n");
    absl::StrAppend(&text, "\n# ", option->get_description(), "\n# ", option->get_lnames().front(), " = ",
                    Toml(WithoutPath(option->get_default_str())), "\n");
  }
  return text;
}

std::string ManualOf(const CLI::App& app) {
  std::string text = absl::StrCat(
      ".TH PHRENICD 1 \"2026-11-22\" \"phrenicd " PHRENIC_VERSION "\" \"User commands\"\n",
      ".SH NAME\nphrenicd \\- simulates the breathing diaphragm and serves it\n",
      ".SH SYNOPSIS\n.B phrenicd\n[settings]\n.SH DESCRIPTION\n", Escaped(app.get_description()),
      " A setting is a flag, else an environment variable (PHRENICD_MAX_SESSIONS for \\-\\-max\\-sessions), else a "
      "line of the settings file, else its default.\n");
  std::string group;
  for (const CLI::Option* option : Settings(app)) {
    if (option->get_group() != group) absl::StrAppend(&text, ".SH ", group = option->get_group(), "\n");
    absl::StrAppend(
        &text, Item(absl::StrCat("--", option->get_lnames().front(), " ", Toml(WithoutPath(option->get_default_str()))),
                    option->get_description()));
  }
  return absl::StrCat(text, ".SH Commands\n", CommandItems(app, "phrenicd"), ".SH FILES\n",
                      Item("/etc/phrenic/phrenicd.toml", "Settings file, read if --config is not set."));
}

}  // namespace phrenic::daemon
