#include "client/cli/command.h"

#include <algorithm>
#include <string>

namespace phrenic::client {

std::span<const Example> Command::examples() const {
  const auto end = std::ranges::find(example_array, nullptr, &Example::line);
  return {std::begin(example_array), end};
}

const Command* FindCommand(CommandTable commands, std::string_view path) {
  const auto found = std::ranges::find(commands, path, &Command::path);
  return found == commands.end() ? nullptr : &*found;
}

bool Supports(const Command& command, Output output) {
  switch (output) {
    case Output::kTable:
    case Output::kJson:
      return true;
    case Output::kCsv:
      return command.formats != Formats::kDocument;
    case Output::kJsonl:
      return command.formats == Formats::kList;
  }
  return false;
}

void AddCommands(CommandTable commands, CLI::App& root, CommandFunction& chosen) {
  for (const Command& row : commands) {
    const std::string path = row.path;
    const std::size_t space = path.rfind(' ');
    CLI::App* parent = space == std::string::npos ? &root : root.get_subcommand(path.substr(0, space));
    CLI::App* command = parent->add_subcommand(space == std::string::npos ? path : path.substr(space + 1), row.summary);
    if (row.set_up == nullptr) {
      command->require_subcommand(1);
    } else {
      command->callback([run = row.set_up(*command), &chosen] { chosen = run; });
    }
  }
}

}  // namespace phrenic::client
