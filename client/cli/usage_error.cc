#include "client/cli/usage_error.h"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/guide.h"
#include "client/cli/help.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

// The command that was meant: the deepest one that was named.
const CLI::App& Deepest(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  return named.empty() ? app : Deepest(*named.back());
}

std::string Typed(const CLI::App& command) {
  const std::string path = PathOf(command);
  return path.empty() ? "phrenic" : "phrenic " + path;
}

std::string Next(const CLI::App& command) {
  std::string text;
  const CommandGuide* guide = GuideOf(PathOf(command));
  if (guide != nullptr) absl::StrAppend(&text, "  for example: ", guide->examples.front().line, "\n");
  return absl::StrCat(text, "  more: ", Typed(command), " --help\n");
}

std::vector<std::string> CommandNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(below->get_name());
  }
  return names;
}

std::string NoSuchCommand(const CLI::App& command, const std::string& word) {
  std::string meant = command.get_parent() == nullptr ? CommandMeantBy(word) : "";
  if (meant.empty()) meant = schema::NearestName(word, CommandNames(command));
  const std::string what = absl::StrCat("there is no command \"", Typed(command), " ", word, "\"");
  if (meant.empty()) return absl::StrCat(what, "\n  those there are: ", Typed(command), " --help\n");
  return absl::StrCat(what, "; did you mean ", meant, "?\n  try: ", Typed(command), " ", meant,
                      absl::StartsWith(meant, "--") ? "" : " --help", "\n");
}

std::string NoSuchOption(const CLI::App& root, const CLI::App& command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* app : {&command, &root}) {
    for (const CLI::Option* option : OptionsOf(*app)) names.push_back(NameOf(*option).substr(2));
  }
  const std::string name = word.substr(0, word.find('='));
  const std::string nearest = schema::NearestName(name.substr(std::min<size_t>(2, name.size())), names);
  return absl::StrCat(Typed(command), " has no option ", name,
                      nearest.empty() ? "" : absl::StrCat("; did you mean --", nearest, "?"), "\n", Next(command));
}

std::string TooMuch(const CLI::App& root, const CLI::App& command) {
  const std::vector<std::string> words = root.remaining(true);
  const std::string word = words.empty() ? "" : words.front();
  if (absl::StartsWith(word, "-")) return NoSuchOption(root, command, word);
  if (command.get_require_subcommand_min() > 0) return NoSuchCommand(command, word);
  return absl::StrCat("\"", word, "\" is one word too many: ", UsageOf(command), "\n", Next(command));
}

// The option's name stands before the first colon of what CLI11 says; where its value came from the environment, that
// is to be corrected.
std::string FromEnvironment(const CLI::App& root, const std::string& message) {
  const CLI::Option* option = root.get_option_no_throw(message.substr(0, message.find(':')));
  if (option == nullptr || option->get_envname().empty()) return "";
  const char* value = std::getenv(option->get_envname().c_str());
  return value == nullptr || option->results() != std::vector<std::string>{value}
             ? ""
             : absl::StrCat(" (from ", option->get_envname(), ")");
}

// "TICKS: "x" is not a number" for CLI11's "Could not convert: TICKS = x": strings are taken as they are.
std::string NoNumber(absl::string_view message) {
  const std::pair<std::string, std::string> parts =
      absl::StrSplit(absl::StripPrefix(message, "Could not convert: "), absl::MaxSplits(" = ", 1));
  double value = 0;
  const char* what = absl::SimpleAtod(parts.second, &value) ? "whole number" : "number";
  return absl::StrCat(parts.first, ": \"", parts.second, "\" is not a ", what);
}

}  // namespace

std::string Explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = Deepest(app);
  const bool lacks_command = command.get_require_subcommand_min() > 0;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return TooMuch(app, command);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (app.remaining_size(true) > 0) return TooMuch(app, command);
    if (lacks_command) return absl::StrCat(Typed(command), " needs a command\n", Next(command));
    return absl::StrCat(Typed(command), ": ", error.what(), ": ", UsageOf(command), "\n", Next(command));
  }
  const bool converts = dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
  if (converts && absl::StartsWith(error.what(), "Could not convert: ")) {
    return absl::StrCat(NoNumber(error.what()), "\n", Next(command));
  }
  return absl::StrCat(error.what(), FromEnvironment(app, error.what()), "\n", Next(command));
}

}  // namespace phrenic::client
