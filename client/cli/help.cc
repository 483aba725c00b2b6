#include "client/cli/help.h"

#include <unistd.h>

#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/guide.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

constexpr int kWidest = 100, kIndent = 2, kMeaningAt = 26;

int HelpWidth() { return std::min(kWidest, WidthOf(STDOUT_FILENO)); }

std::string Heading(const std::string& words) {
  return absl::StrCat("\n", Painted(words, Ink::kBold, STDOUT_FILENO), "\n");
}

// Returns two columns. The second starts on the next line if the first is too long.
std::string Pair(const std::string& first, const std::string& second) {
  const int at = std::min(kMeaningAt, HelpWidth() / 3);
  std::string text = std::string(kIndent, ' ') + first;
  if (second.empty()) return text + "\n";
  const int used = kIndent + ColumnsOf(first);
  text += used + 1 < at ? std::string(at - used, ' ') : "\n" + std::string(at, ' ');
  return text + Wrapped(second, HelpWidth(), at) + "\n";
}

// NumberIn adds its range to the type: "FLOAT: in [0.5 to 50]".
constexpr char kRangeBegins[] = ": in [";

std::string RangeOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t from = type.find(kRangeBegins), to = type.find(']', from);
  if (from == std::string::npos || to == std::string::npos) return "";
  return type.substr(from + sizeof kRangeBegins - 1, to - from - sizeof kRangeBegins + 1);
}

std::string Examples(std::span<const Example> examples) {
  std::string text;
  for (const Example& example : examples) {
    absl::StrAppend(&text, "  ", Painted(example.line, Ink::kCyan, STDOUT_FILENO), "\n");
    if (*example.meaning != 0) absl::StrAppend(&text, "      ", Wrapped(example.meaning, HelpWidth(), 6), "\n");
  }
  return text;
}

std::string List(const char* heading, const std::vector<const CLI::Option*>& options) {
  if (options.empty()) return "";
  std::string text = Heading(heading);
  for (const CLI::Option* option : options) text += Pair(LabelOf(*option), MeaningOf(*option));
  return text;
}

std::string List(const char* heading, std::span<const NamedText> rows) {
  std::string text = Heading(heading);
  for (const NamedText& row : rows) text += Pair(row.name, row.meaning);
  return text;
}

std::string Parameters() {
  std::string text, group;
  for (const ParameterRow& row : ParameterRows()) {
    if (row.group != group) text += Heading(row.group);
    group = row.group;
    text += Pair(row.name, MeaningOf(row));
  }
  return text;
}

std::string PhysiqueNumbers() {
  std::string text = Heading("Body, set by NAME=VALUE");
  for (const ParameterRow& row : PhysiqueRows()) text += Pair(row.name, MeaningOf(row));
  return text;
}

bool HasKind(const CLI::App& command, Kind kind) {
  return std::ranges::any_of(command.get_options(),
                             [&](const CLI::Option* option) { return KindOf(command, *option).kind == kind; });
}

std::string CommandsOf(const CLI::App& command) {
  const auto below = command.get_subcommands([](const CLI::App*) { return true; });
  std::string text = below.empty() ? "" : Heading("Commands");
  for (const CLI::App* one : below) text += Pair(one->get_name(), one->get_description());
  return text;
}

std::string CommandsByGroup(CommandTable commands) {
  std::string text, group;
  for (const Command& command : commands) {
    if (*command.group == 0) continue;
    if (command.group != group) text += Heading(command.group);
    group = command.group;
    text += Pair(command.path, command.summary);
  }
  return text;
}

std::string Beginning(const CLI::App& root) {
  return absl::StrCat(Wrapped(root.get_description(), HelpWidth(), 0), "\n", Heading("Usage"), "  ", UsageOf(root),
                      "\n", Heading("Examples"), Examples(FirstExamples()));
}

std::string RootHelp(const CLI::App& root, CommandTable commands) {
  std::string text = Beginning(root) + CommandsByGroup(commands) + List("Options of every command", OptionsOf(root));
  text += List("Environment", EnvironmentVariables()) + List("Exit codes", ExitCodes());
  text += "\n" + Wrapped(SettingsText(), HelpWidth(), 0) + "\n";
  return text + "\n" +
         Wrapped("Help for one command: phrenic COMMAND --help. The manual: phrenic man | man -l -", HelpWidth(), 0) +
         "\n";
}

std::string CommandHelp(const CLI::App& command, CommandTable commands) {
  std::string text = Wrapped(command.get_description(), HelpWidth(), 0) + "\n";
  text += Heading("Usage") + "  " + Wrapped(UsageOf(command), HelpWidth(), 6) + "\n";
  const Command* row = FindCommand(commands, PathOf(command));
  if (row != nullptr && !row->examples().empty()) text += Heading("Examples") + Examples(row->examples());
  text += CommandsOf(command) + List("Arguments", PositionalsOf(command)) + List("Options", OptionsOf(command));
  if (TakesPhysique(command)) text += PhysiqueNumbers();
  if (SetsParameters(command)) text += Heading("Parameters, set by NAME=VALUE") + Parameters();
  text += command.get_footer();
  return text + "\n" +
         Wrapped("Options of every command, such as --server and --output: phrenic --help", HelpWidth(), 0) + "\n";
}

}  // namespace

std::string ShortHelp(const CLI::App& root) { return Beginning(root) + "\nAll commands and options: phrenic --help\n"; }

std::vector<const CLI::Option*> PositionalsOf(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<const CLI::Option*> OptionsOf(const CLI::App& command) {
  return command.get_options([&](const CLI::Option* option) {
    return option->nonpositional() && !option->get_group().empty() && option != command.get_help_ptr();
  });
}

std::string UsageOf(const CLI::App& command) {
  const std::string path = PathOf(command);
  std::string usage = path.empty() ? "phrenic" : absl::StrCat("phrenic ", path);
  if (command.get_require_subcommand_min() > 0) return usage + " COMMAND [options]";
  for (const CLI::Option* option : PositionalsOf(command)) {
    const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
    const std::string name = absl::StrCat(option->get_name(true), many ? "..." : "");
    absl::StrAppend(&usage, " ", option->get_required() ? name : "[" + name + "]");
  }
  for (const CLI::Option* option : OptionsOf(command)) {
    if (option->get_required()) absl::StrAppend(&usage, " ", LabelOf(*option));
  }
  return OptionsOf(command).empty() ? usage : usage + " [options]";
}

std::string LabelOf(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names = absl::StrReplaceAll(option.get_name(false, true), {{",", ", "}});
  if (option.get_items_expected_max() == 0) return names;
  const std::string whole = option.get_type_name();
  const std::string type = whole.substr(0, whole.find(kRangeBegins));
  const bool number = type == "FLOAT" || type == "INT" || type == "UINT";
  return absl::StrCat(names, " ", number ? "N" : type);
}

std::string MeaningOf(const CLI::Option& option) {
  std::vector<std::string> notes;
  if (option.get_required() && !option.get_positional()) notes.emplace_back("required");
  if (const std::string range = RangeOf(option); !range.empty()) notes.push_back(range);
  if (!option.get_default_str().empty()) notes.push_back(option.get_default_str());
  if (!option.get_envname().empty()) notes.push_back(option.get_envname());
  for (const CLI::Option* other : option.get_needs()) notes.push_back("with " + other->get_name());
  std::set<std::string> excluded;  // in the order of the names: the options' own order is that of their addresses
  for (const CLI::Option* other : option.get_excludes()) excluded.insert(other->get_name());
  if (!excluded.empty()) notes.push_back("not with " + absl::StrJoin(excluded, ", "));
  const std::string& text = option.get_description();
  return notes.empty() ? text : absl::StrCat(text, text.empty() ? "(" : " (", absl::StrJoin(notes, "; "), ")");
}

std::string MeaningOf(const ParameterRow& parameter) {
  return absl::StrCat(parameter.meaning, " (", parameter.range, parameter.unit.empty() ? "" : " ", parameter.unit, "; ",
                      parameter.default_value, ")");
}

bool SetsParameters(const CLI::App& command) { return HasKind(command, Kind::kSetting); }

bool TakesPhysique(const CLI::App& command) { return HasKind(command, Kind::kPhysique); }

std::string HelpFormatter::make_help(const CLI::App* command, std::string /*name*/, CLI::AppFormatMode /*mode*/) const {
  return command->get_parent() == nullptr ? RootHelp(*command, commands_) : CommandHelp(*command, commands_);
}

}  // namespace phrenic::client
