#include "client/cli/manual.h"

#include <span>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/guide.h"
#include "client/cli/help.h"
#include "client/cli/parameter_rows.h"

namespace phrenic::client {
namespace {

// Escapes text so that no line starts like a request.
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

std::string NamedItems(std::span<const NamedText> rows) {
  std::string text;
  for (const NamedText& row : rows) absl::StrAppend(&text, Item(row.name, row.meaning));
  return text;
}

std::string ArgumentItems(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : PositionalsOf(command)) text += Item(LabelOf(*option), MeaningOf(*option));
  for (const CLI::Option* option : OptionsOf(command)) text += Item(LabelOf(*option), MeaningOf(*option));
  return text;
}

std::string PhysiqueItems() {
  std::string text;
  for (const ParameterRow& row : PhysiqueRows()) text += Item(row.name, MeaningOf(row));
  return text;
}

std::string ParameterItems() {
  std::string text, group;
  for (const ParameterRow& row : ParameterRows()) {
    if (row.group != group) absl::StrAppend(&text, ".SS \"", RoffEscaped(row.group), "\"\n");
    group = row.group;
    text += Item(row.name, MeaningOf(row));
  }
  return text;
}

void AddCommandText(const CLI::App& command, CommandTable commands, std::string& text) {
  const bool leaf = command.get_require_subcommand_min() == 0;
  if (leaf) {
    absl::StrAppend(&text, ".SS \"", RoffEscaped(UsageOf(command)), "\"\n", RoffEscaped(command.get_description()),
                    ".\n", ArgumentItems(command));
    const Command* row = FindCommand(commands, PathOf(command));
    if (row != nullptr && !row->examples().empty()) {
      absl::StrAppend(&text, ".PP\nExamples:\n", ExampleItems(row->examples()));
    }
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    AddCommandText(*below, commands, text);
  }
}

}  // namespace

std::string ManualOf(const CLI::App& root, CommandTable commands) {
  std::string text = ".TH PHRENIC 1 \"2026-11-22\" \"phrenic " PHRENIC_VERSION "\" \"User commands\"\n";
  absl::StrAppend(&text, ".SH NAME\nphrenic \\- simulate the breathing diaphragm\n",
                  ".SH SYNOPSIS\n.B phrenic\n.I COMMAND\n[options]\n", ".SH DESCRIPTION\n",
                  RoffEscaped(root.get_description()), "\n.SH EXAMPLES\n", ExampleItems(FirstExamples()));
  absl::StrAppend(&text, ".SH OPTIONS\nOptions of every command:\n", ArgumentItems(root), ".SH COMMANDS\n");
  for (const CLI::App* command : root.get_subcommands([](const CLI::App*) { return true; })) {
    AddCommandText(*command, commands, text);
  }
  absl::StrAppend(&text, ".SH PARAMETERS\nSet by \\-\\-set and by `phrenic set`:\n", ParameterItems(),
                  ".SH BODIES\nNumbers of a body, set by \\-\\-physique:\n", PhysiqueItems(), ".SH SETTINGS\n",
                  RoffEscaped(SettingsText()), "\n.SH ENVIRONMENT\n", NamedItems(EnvironmentVariables()),
                  ".SH EXIT STATUS\n", NamedItems(ExitCodes()));
  return text;
}

}  // namespace phrenic::client
