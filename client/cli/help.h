// `--help`: what a command does, its usage, examples and arguments, in the terminal's width.
#ifndef PHRENIC_CLIENT_CLI_HELP_H_
#define PHRENIC_CLIENT_CLI_HELP_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "client/cli/command.h"
#include "client/cli/parameter_rows.h"

namespace phrenic::client {

class HelpFormatter final : public CLI::Formatter {
 public:
  explicit HelpFormatter(CommandTable commands) : commands_(commands) {}
  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override;

 private:
  const CommandTable commands_;
};

// Returns the help for `phrenic` without a command.
std::string ShortHelp(const CLI::App& root);

// Returns "Step of the integrator. (1e-07 to 0.1 s; automatic)".
std::string MeaningOf(const ParameterRow& parameter);
// True if one of the command's arguments sets parameters.
bool SetsParameters(const CLI::App& command);
// True if an option of the command takes numbers of a body.
bool TakesPhysique(const CLI::App& command);

// Returns "phrenic run SCENE [options]".
std::string UsageOf(const CLI::App& command);
// Returns "-o, --output FORMAT", or a positional argument's name.
std::string LabelOf(const CLI::Option& option);
// Returns the option's help with its range, default and environment variable: "simulated time [s] (1e-06 to 3600; 8)".
std::string MeaningOf(const CLI::Option& option);
// Returns the command's positional arguments.
std::vector<const CLI::Option*> PositionalsOf(const CLI::App& command);
// Returns the command's options, without --help.
std::vector<const CLI::Option*> OptionsOf(const CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_HELP_H_
