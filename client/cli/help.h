// `--help`: what a command does, how it is typed, by examples first, in the terminal's width.
#ifndef PHRENIC_CLIENT_CLI_HELP_H_
#define PHRENIC_CLIENT_CLI_HELP_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "client/cli/scene_argument.h"

namespace phrenic::client {

class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override;
};

// For who types no command: how it begins.
std::string ShortHelp(const CLI::App& root);

// "Step of the integrator. (s, 1e-07 to 0.1; automatic)".
std::string MeaningOf(const ParameterRow& parameter);
// Whether one of the command's arguments sets parameters.
bool SetsParameters(const CLI::App& command);

// "phrenic run SCENE [options]".
std::string UsageOf(const CLI::App& command);
// "-o,--output FORMAT"; a positional's name.
std::string LabelOf(const CLI::Option& option);
// What it means, with its range, its default and its variable: "simulated time [s] (1e-06 to 3600; 8)".
std::string MeaningOf(const CLI::Option& option);
// What people may type: positionals, or options but for --help.
std::vector<const CLI::Option*> PositionalsOf(const CLI::App& command);
std::vector<const CLI::Option*> OptionsOf(const CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_HELP_H_
