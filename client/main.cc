// The command line client.
#include "client/cli/command_line.h"

int main(int argc, char** argv) {
  phrenic::client::Interruption interruption;
  return phrenic::client::RunCommandLine(argc, argv, interruption);
}
