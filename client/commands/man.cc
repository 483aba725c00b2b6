// `phrenic man`: the manual page.
#include <iostream>

#include "client/cli/manual.h"
#include "client/commands/commands.h"

namespace phrenic::client {

CommandFunction SetUpMan(CLI::App& command) {
  return [&root = *command.get_parent()](const Context&) {
    std::cout << ManualOf(root, Commands());
    return kOk;
  };
}

}  // namespace phrenic::client
