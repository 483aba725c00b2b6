// The settings of phrenicd: flags, the environment, a file.
#ifndef PHRENIC_SERVER_DAEMON_FLAGS_H_
#define PHRENIC_SERVER_DAEMON_FLAGS_H_

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "server/service/server.h"

namespace phrenic::daemon {

struct Flags {
  service::ServerOptions options;                           // but for the sizes below
  int message_mb = 16, upload_mb = 256, uploads_mb = 1024;  // [MiB]
  std::string start = "thorax";
  std::string config;        // the settings file; empty: none
  std::string log = "text";  // or "json"
  double stop_seconds = 10;  // from the signal to the end
};

// One option a setting, each with its variable PHRENICD_NAME; `flags` outlives the app.
void AddFlags(CLI::App& app, Flags& flags);

// What the server is started with.
service::ServerOptions OptionsOf(const Flags& flags);

// --config of the words, else $PHRENICD_CONFIG, else /etc/phrenic/phrenicd.toml where it is; else empty.
std::string ConfigFile(const std::vector<std::string>& words);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_FLAGS_H_
