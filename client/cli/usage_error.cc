#include "client/cli/usage_error.h"

#include <algorithm>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/guide.h"
#include "client/cli/help.h"
#include "client/terminal/environment.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

// Returns the deepest command that was named.
const CLI::App& SelectedCommand(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  return named.empty() ? app : SelectedCommand(*named.back());
}

std::string FullName(const CLI::App& command) {
  const std::string path = PathOf(command);
  return path.empty() ? "phrenic" : "phrenic " + path;
}

std::string NextSteps(const CLI::App& command, CommandTable commands) {
  std::string text;
  const Command* row = FindCommand(commands, PathOf(command));
  if (row != nullptr && !row->examples().empty()) {
    absl::StrAppend(&text, "  example: ", row->examples().front().line, "\n");
  }
  return absl::StrCat(text, "  help: ", FullName(command), " --help\n");
}

std::vector<std::string> CommandNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(below->get_name());
  }
  return names;
}

std::string NoSuchCommand(const CLI::App& command, const std::string& word) {
  const bool at_top = command.get_parent() == nullptr;
  const std::vector<std::string> names = CommandNames(command);
  const std::string meant = at_top ? CommandMeantBy(word, names) : schema::NearestName(word, names);
  const std::string what = absl::StrCat("there is no command \"", FullName(command), " ", word, "\"");
  if (meant.empty()) return absl::StrCat(what, "\n  all commands: ", FullName(command), " --help\n");
  if (meant == "--help")
    return absl::StrCat(what, "; the commands and first examples are in the help\n  try: phrenic --help\n");
  return absl::StrCat(what, "; did you mean ", meant, "?\n  try: ", FullName(command), " ", meant,
                      absl::StartsWith(meant, "--") ? "" : " --help", "\n");
}

std::string NoSuchOption(const CLI::App& root, const CLI::App& command, CommandTable commands,
                         const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* app : {&command, &root}) {
    for (const CLI::Option* option : OptionsOf(*app)) names.push_back(NameOf(*option).substr(2));
  }
  names.emplace_back("help");  // not among OptionsOf
  const std::string name = word.substr(0, word.find('='));
  const std::string nearest = schema::NearestName(name.substr(std::min<size_t>(2, name.size())), names);
  return absl::StrCat(FullName(command), " has no option ", name,
                      nearest.empty() ? "" : absl::StrCat("; did you mean --", nearest, "?"), "\n",
                      NextSteps(command, commands));
}

std::string ExtraWord(const CLI::App& root, const CLI::App& command, CommandTable commands) {
  const std::vector<std::string> words = root.remaining(true);
  const std::string word = words.empty() ? "" : words.front();
  if (absl::StartsWith(word, "-")) return NoSuchOption(root, command, commands, word);
  if (command.get_require_subcommand_min() > 0) return NoSuchCommand(command, word);
  return absl::StrCat("\"", word, "\" is an unexpected argument: ", UsageOf(command), "\n",
                      NextSteps(command, commands));
}

// Returns " (from VARIABLE)" if the option's value came from the environment. CLI11's message starts with the option's
// name and a colon.
std::string FromEnvironment(const CLI::App& root, const std::string& message) {
  const CLI::Option* option = root.get_option_no_throw(message.substr(0, message.find(':')));
  if (option == nullptr || option->get_envname().empty()) return "";
  const std::string value = EnvironmentVariable(option->get_envname().c_str());
  return value.empty() || option->results() != std::vector<std::string>{value}
             ? ""
             : absl::StrCat(" (from ", option->get_envname(), ")");
}

// Returns "TICKS: "x" is not a number" for CLI11's "Could not convert: TICKS = x".
std::string NoNumber(absl::string_view message) {
  const std::pair<std::string, std::string> parts =
      absl::StrSplit(absl::StripPrefix(message, "Could not convert: "), absl::MaxSplits(" = ", 1));
  double value = 0;
  const char* what = absl::SimpleAtod(parts.second, &value) ? "whole number" : "number";
  return absl::StrCat(parts.first, ": \"", parts.second, "\" is not a ", what);
}

}  // namespace

std::string Explain(const CLI::App& root, CommandTable commands, const CLI::ParseError& error) {
  const CLI::App& command = SelectedCommand(root);
  const bool needs_subcommand = command.get_require_subcommand_min() > 0;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return ExtraWord(root, command, commands);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (root.remaining_size(true) > 0) return ExtraWord(root, command, commands);
    if (needs_subcommand) return absl::StrCat(FullName(command), " needs a subcommand\n", NextSteps(command, commands));
    return absl::StrCat(FullName(command), ": ", error.what(), ": ", UsageOf(command), "\n",
                        NextSteps(command, commands));
  }
  const bool converts = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
  if (converts && absl::StartsWith(error.what(), "Could not convert: ")) {
    return absl::StrCat(NoNumber(error.what()), "\n", NextSteps(command, commands));
  }
  return absl::StrCat(error.what(), FromEnvironment(root, error.what()), "\n", NextSteps(command, commands));
}

}  // namespace phrenic::client
