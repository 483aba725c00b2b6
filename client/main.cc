// The command line client, phrenic.
#include <cstdlib>

#include "client/cli/command_line.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/terminal/standard_output.h"

int main(int argc, char** argv) {
  // gRPC resolves names as other programs do (nsswitch.conf); its own resolver knows DNS and /etc/hosts alone.
  setenv("GRPC_DNS_RESOLVER", "native", 0);
  phrenic::client::Interruption interruption;
  phrenic::client::StandardOutput output;
  const int code = phrenic::client::RunCommandLine({argv + 1, argv + argc}, phrenic::client::Commands(), interruption);
  const absl::Status printed = output.Finish();
  if (printed.ok()) return code;
  const int lost = phrenic::client::Fail(printed);
  return code == phrenic::client::kOk ? lost : code;
}
