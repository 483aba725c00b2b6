// What the groups of commands have in common: how a command is hung into the tree, and options that several have.
#ifndef PHRENIC_CLIENT_COMMANDS_COMMAND_TREE_H_
#define PHRENIC_CLIENT_COMMANDS_COMMAND_TREE_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/argument_kinds.h"
#include "client/cli/schema_options.h"
#include "client/commands/commands.h"
#include "client/print/comparison.h"
#include "server/schema/fields.h"

namespace phrenic::client {

// A group adds its commands when it is made, keeps their options while the command line is parsed and run, and says in
// `chosen` which of them is to be run. The references outlive it.
class CommandTree {
 public:
  CommandTree(const CommandTree&) = delete;
  CommandTree& operator=(const CommandTree&) = delete;

 protected:
  CommandTree(CLI::App& app, const Context& context, std::function<int()>& chosen)
      : app_(app), context_(context), chosen_(chosen) {}

  template <typename Function, typename Options>
  CLI::App* Add(const char* name, const char* help, Function function, Options& options, CLI::App* to = nullptr) {
    CLI::App* command = (to == nullptr ? &app_ : to)->add_subcommand(name, help);
    command->callback(
        [this, function, &options] { chosen_ = [this, function, &options] { return function(context_, options); }; });
    return command;
  }

  CLI::App* Add(const char* name, const char* help, int (*function)(const Context&), CLI::App* to = nullptr) {
    CLI::App* command = (to == nullptr ? &app_ : to)->add_subcommand(name, help);
    command->callback([this, function] { chosen_ = [this, function] { return function(context_); }; });
    return command;
  }

  static void AddScene(CLI::App* command, SceneOptions& options);
  static void AddParameters(CLI::App* command, std::vector<std::string>& settings);
  static void AddPulls(CLI::App* command, std::vector<std::string>& pulls);
  static void AddPreset(CLI::App* command, std::string& preset);
  static void AddMotion(CLI::App* command, MotionOptions& motion);
  // " (.msh, .obj*; * of one instant)"
  static std::string ExportEndings();

  template <typename Value>
  static void AddNumber(CLI::App* command, const char* flag, Value& value, const google::protobuf::Descriptor& message,
                        const char* field) {
    const v1::Quantity& quantity = *schema::QuantityOf(*message.FindFieldByName(field));
    command->add_option(flag, value, FieldHelp(message, field))
        ->check(NumberIn(quantity.minimum(), quantity.maximum()));
  }

  CLI::App& app_;
  const Context& context_;
  std::function<int()>& chosen_;
};

// Scenes, studies, campaigns, files and patients: what needs no running server.
std::shared_ptr<void> AddSceneCommands(CLI::App& app, const Context& context, std::function<int()>& chosen);
// Sessions of a server, who controls them, exports, uploads, and the command line itself.
std::shared_ptr<void> AddSessionCommands(CLI::App& app, const Context& context, std::function<int()>& chosen);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_COMMANDS_COMMAND_TREE_H_
