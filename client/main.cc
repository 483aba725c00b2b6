// The command line client, phrenic.
#include "client/cli/command_line.h"
#include "client/commands/commands.h"

int main(int argc, char** argv) {
  phrenic::client::Interruption interruption;
  return phrenic::client::RunCommandLine({argv + 1, argv + argc}, phrenic::client::Commands(), interruption);
}
