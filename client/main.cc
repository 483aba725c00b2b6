// The command line client, phrenic.
#include <cstdlib>

#include "client/cli/command_line.h"
#include "client/commands/commands.h"

int main(int argc, char** argv) {
  // gRPC resolves names as other programs do (nsswitch.conf); its own resolver knows DNS and /etc/hosts alone.
  setenv("GRPC_DNS_RESOLVER", "native", 0);
  phrenic::client::Interruption interruption;
  return phrenic::client::RunCommandLine({argv + 1, argv + argc}, phrenic::client::Commands(), interruption);
}
