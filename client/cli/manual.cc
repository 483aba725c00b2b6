#include "client/cli/manual.h"

#include <span>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/guide.h"
#include "client/cli/help.h"
#include "client/cli/scene_argument.h"

namespace phrenic::client {
namespace {

// A line of text may not begin as a request does.
std::string RoffEscaped(const std::string& text) {
  std::string safe = absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}, {"\n.", "\n\\&."}, {"\n'", "\n\\&'"}});
  if (safe.starts_with('.') || safe.starts_with('\'')) safe = "\\&" + safe;
  return safe;
}

std::string Item(const std::string& label, const std::string& meaning) {
  return absl::StrCat(".TP\n.B ", RoffEscaped(label), "\n", meaning.empty() ? "\\&" : RoffEscaped(meaning), "\n");
}

std::string ExampleItems(std::span<const Example> examples) {
  std::string text;
  for (const Example& example : examples) absl::StrAppend(&text, Item(example.line, example.meaning));
  return text;
}

std::string NamedItems(std::span<const Named> rows) {
  std::string text;
  for (const Named& row : rows) absl::StrAppend(&text, Item(row.name, row.meaning));
  return text;
}

std::string ArgumentItems(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : PositionalsOf(command)) text += Item(LabelOf(*option), MeaningOf(*option));
  for (const CLI::Option* option : OptionsOf(command)) text += Item(LabelOf(*option), MeaningOf(*option));
  return text;
}

std::string ParameterItems() {
  std::string text;
  for (const ParameterRow& row : ParameterRows()) text += Item(row.name, MeaningOf(row));
  return text;
}

void AddCommand(const CLI::App& command, std::string& text) {
  const bool leaf = command.get_require_subcommand_min() == 0;
  if (leaf) {
    absl::StrAppend(&text, ".SS \"", RoffEscaped(UsageOf(command)), "\"\n", RoffEscaped(command.get_description()),
                    ".\n", ArgumentItems(command));
    const CommandGuide* guide = GuideOf(PathOf(command));
    if (guide != nullptr) absl::StrAppend(&text, ".PP\nExamples:\n", ExampleItems(guide->examples));
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) AddCommand(*below, text);
}

}  // namespace

std::string ManualOf(const CLI::App& app) {
  std::string text = ".TH PHRENIC 1 \"2026-11-22\" \"phrenic " PHRENIC_VERSION "\" \"User commands\"\n";
  absl::StrAppend(&text, ".SH NAME\nphrenic \\- the breathing diaphragm, simulated\n",
                  ".SH SYNOPSIS\n.B phrenic\n.I COMMAND\n[options]\n", ".SH DESCRIPTION\n",
                  RoffEscaped(app.get_description()), "\n.SH EXAMPLES\n", ExampleItems(FirstExamples()));
  absl::StrAppend(&text, ".SH OPTIONS\nOf every command:\n", ArgumentItems(app), ".SH COMMANDS\n");
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) AddCommand(*command, text);
  absl::StrAppend(&text, ".SH PARAMETERS\nOf \\-\\-set, and of `phrenic set`:\n", ParameterItems(), ".SH SETTINGS\n",
                  RoffEscaped(SettingsText()), "\n.SH ENVIRONMENT\n", NamedItems(EnvironmentVariables()),
                  ".SH EXIT STATUS\n", NamedItems(ExitCodes()));
  return text;
}

}  // namespace phrenic::client
