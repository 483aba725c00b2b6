#include "client/cli/completion.h"

#include <iostream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/cli/help.h"
#include "client/cli/known_names.h"

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

// The position of the last word: its command and its argument.
struct Position {
  const CLI::App* command;
  int positionals = 0;                  // number of positional arguments before it
  const CLI::Option* option = nullptr;  // the option whose value it is; null if it is none
};

const CLI::Option* FindOption(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command = &app; command != nullptr; command = command->get_parent()) {
    if (const CLI::Option* option = command->get_option_no_throw(name); option != nullptr) return option;
  }
  return nullptr;
}

// Returns the subcommand of that name; null if there is none.
const CLI::App* FindBelow(const CLI::App& command, const std::string& name) {
  const auto found = command.get_subcommands([&](const CLI::App* below) { return below->get_name() == name; });
  return found.empty() ? nullptr : found.front();
}

Position PositionOfLast(const CLI::App& app, const Words& words) {
  Position position{&app};
  for (size_t i = 1; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (position.option != nullptr) {
      position.option = nullptr;
    } else if (absl::StartsWith(word, "-")) {
      const CLI::Option* option = FindOption(*position.command, word);
      if (option != nullptr && option->get_items_expected_max() > 0) position.option = option;
    } else if (const CLI::App* below = FindBelow(*position.command, word);
               below != nullptr && position.positionals == 0) {
      position.command = below;
    } else {
      ++position.positionals;
    }
  }
  return position;
}

std::string FirstSentence(const std::string& text) { return text.substr(0, text.find(". ")); }

std::vector<Candidate> SubcommandsOf(const CLI::App& command) {
  std::vector<Candidate> commands;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back({below->get_name(), FirstSentence(below->get_description())});
  }
  return commands;
}

std::vector<Candidate> OptionNames(const CLI::App& app) {
  std::vector<Candidate> names;
  for (const CLI::App* command = &app; command != nullptr; command = command->get_parent()) {
    for (const CLI::Option* option : OptionsOf(*command)) {
      names.push_back({NameOf(*option), FirstSentence(option->get_description())});
    }
  }
  names.push_back({"--help", "print help with examples"});
  return names;
}

Candidates ValuesOf(const CLI::App& command, const CLI::Option& option, const Words& words, const Lookup& lookup) {
  const ArgumentKind kind = KindOf(command, option);
  switch (kind.kind) {
    case Kind::kOther:
      return {};
    case Kind::kFile:
      return {{}, Directive::kFiles};
    case Kind::kFolder:
      return {{}, Directive::kFolders};
    case Kind::kScene:
      return {lookup(kind.kind, words), Directive::kFiles};
    case Kind::kSetting:
    case Kind::kPhysique:
      return {lookup(kind.kind, words), Directive::kNoSpace};
    case Kind::kChoice: {
      Candidates choices;
      for (const std::string& choice : kind.choices) choices.words.push_back({choice, ""});
      return choices;
    }
    default:
      return {lookup(kind.kind, words), Directive::kNothing};
  }
}

Candidates CandidatesAt(const Position& position, const Words& words, const Lookup& lookup) {
  if (position.option != nullptr) {
    const CLI::App* owner = position.command;
    while (owner->get_option_no_throw(NameOf(*position.option)) != position.option) owner = owner->get_parent();
    return ValuesOf(*owner, *position.option, words, lookup);
  }
  if (absl::StartsWith(words.back(), "-")) return {OptionNames(*position.command), Directive::kNothing};
  if (position.command->get_require_subcommand_min() > 0)
    return {SubcommandsOf(*position.command), Directive::kNothing};
  const auto positionals = PositionalsOf(*position.command);
  if (positionals.empty()) return {};
  const bool many = positionals.back()->get_expected_max() >= CLI::detail::expected_max_vector_size;
  const auto index = static_cast<size_t>(position.positionals);
  if (index >= positionals.size() && !many) return {};
  return ValuesOf(*position.command, *positionals[std::min(index, positionals.size() - 1)], words, lookup);
}

// Completes the value in "--output=js"; the candidates keep the "--output=".
Candidates AfterEquals(const CLI::App& app, Words words, const Lookup& lookup) {
  const std::string last = words.back();
  const std::string name = last.substr(0, last.find('='));
  words.back() = name;
  words.push_back(last.substr(name.size() + 1));
  Candidates candidates = Complete(app, words, lookup);
  for (Candidate& candidate : candidates.words) candidate.word = absl::StrCat(name, "=", candidate.word);
  return candidates;
}

const char* DirectiveText(Directive directive) {
  switch (directive) {
    case Directive::kNothing:
      return ":nothing";
    case Directive::kFiles:
      return ":files";
    case Directive::kFolders:
      return ":folders";
    case Directive::kNoSpace:
      return ":nospace";
  }
  return "";
}

}  // namespace

std::vector<std::string> SplitLine(const std::string& line) {
  Words words(1);
  char quote = 0;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != 0 && c == quote) {
      quote = 0;
    } else if (c == '\\' && quote != '\'' && i + 1 < line.size()) {
      words.back() += line[++i];
    } else if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (quote == 0 && (c == ' ' || c == '\t')) {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

Candidates Complete(const CLI::App& app, const std::vector<std::string>& words, const Lookup& lookup) {
  const std::string& last = words.back();
  if (words.size() < 2) return {};
  const Position position = PositionOfLast(app, words);
  if (position.option == nullptr && absl::StartsWith(last, "--") && absl::StrContains(last, "=")) {
    return AfterEquals(app, words, lookup);
  }
  Candidates candidates = CandidatesAt(position, words, lookup);
  std::erase_if(candidates.words, [&](const Candidate& candidate) { return !absl::StartsWith(candidate.word, last); });
  // A complete setting is followed by a space.
  const bool names_left = std::ranges::any_of(candidates.words, [](const auto& one) { return one.word.back() == '='; });
  if (candidates.directive == Directive::kNoSpace && !names_left) candidates.directive = Directive::kNothing;
  return candidates;
}

void PrintCandidates(const CLI::App& app, const std::string& line) {
  const Candidates candidates = Complete(app, SplitLine(line), KnownNames(app));
  for (const Candidate& candidate : candidates.words) {
    std::cout << candidate.word << (candidate.meaning.empty() ? "" : "\t") << candidate.meaning << "\n";
  }
  std::cout << DirectiveText(candidates.directive) << "\n";
}

}  // namespace phrenic::client
