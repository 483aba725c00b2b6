// The table of commands: one row describes a command for parsing, help, completion, the manual page and errors.
#ifndef PHRENIC_CLIENT_CLI_COMMAND_H_
#define PHRENIC_CLIENT_CLI_COMMAND_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <span>
#include <string_view>

#include "client/connection/context.h"

namespace phrenic::client {

struct Example {
  const char* line = nullptr;  // what the user types
  const char* meaning = "";    // may be empty
};

// The output formats of a command, in addition to table and json.
enum class Formats { kDocument, kTable, kList };  // none; csv; csv and jsonl

// Runs a command with the options that were parsed. Returns the exit code.
using CommandFunction = std::function<int(const Context& context)>;

struct Command {
  static constexpr int kMostExamples = 5;

  const char* path;     // "run", "study error"
  const char* group;    // heading in `phrenic --help`; empty for a subcommand
  const char* summary;  // one sentence without a full stop
  Formats formats;
  // Adds the command's arguments to `command`. The function returned keeps their values. Null if the command has only
  // subcommands.
  CommandFunction (*set_up)(CLI::App& command);
  Example example_array[kMostExamples] = {};  // the first unset one ends the list

  std::span<const Example> examples() const;
};

// A command's row precedes those of its subcommands. The order is that of the help.
using CommandTable = std::span<const Command>;

// Returns the row of a command; null if there is none.
const Command* FindCommand(CommandTable commands, std::string_view path);

// True if the command supports the output format.
bool Supports(const Command& command, Output output);

// Adds every command to `root`. Parsing sets `chosen` to the function of the command that was typed. Requires: `chosen`
// outlives `root`.
void AddCommands(CommandTable commands, CLI::App& root, CommandFunction& chosen);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_COMMAND_H_
