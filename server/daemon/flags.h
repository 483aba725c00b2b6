// The settings of phrenicd, from flags, environment variables and a settings file.
#ifndef PHRENIC_SERVER_DAEMON_FLAGS_H_
#define PHRENIC_SERVER_DAEMON_FLAGS_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "server/service/server.h"

namespace phrenic::daemon {

struct Flags {
  service::ServerOptions options;  // except the sizes below; OptionsOf adds them
  int message_mb = 16, upload_mb = 256, uploads_mb = 1024, uploads_mb_of_user = 256;  // [MiB]
  std::string start = "thorax";
  std::string config;        // settings file; empty: none
  std::string log = "text";  // or "json"
  double stop_seconds = 10;  // from the signal until the process is aborted [s]
};

// Adds one option per setting, each with an environment variable PHRENICD_NAME. `flags` outlives the app.
void AddFlags(CLI::App& app, Flags& flags);

// Returns the options that the server is started with.
service::ServerOptions OptionsOf(const Flags& flags);

// Returns the value of --config in the command line, else $PHRENICD_CONFIG, else /etc/phrenic/phrenicd.toml if it
// exists, else an empty string.
std::string ConfigFile(const std::vector<std::string>& words);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_FLAGS_H_
