#include "client/commands/commands.h"

#include "client/cli/command_line.h"
#include "client/commands/command_tree.h"

namespace phrenic::client {

std::shared_ptr<void> AddCommands(CLI::App& app, const Context& context, std::function<int()>& chosen) {
  using Groups = std::vector<std::shared_ptr<void>>;
  return std::make_shared<Groups>(
      Groups{AddSceneCommands(app, context, chosen), AddSessionCommands(app, context, chosen)});
}

}  // namespace phrenic::client
