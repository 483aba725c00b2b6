// phrenicd: reads settings, then serves until a signal arrives or runs one of its commands.
#include <cstdlib>
#include <iostream>

#include "absl/synchronization/mutex.h"
#include "server/daemon/commands.h"
#include "server/daemon/flags.h"
#include "server/daemon/log.h"
#include "server/daemon/manual.h"
#include "server/daemon/serve.h"
#include "server/settings/settings_file.h"

namespace phrenic::daemon {
namespace {

int Refuse(const absl::Status& status) {
  std::cerr << "phrenicd: " << std::string(status.message()) << "\n";
  return kUsage;
}

int Main(int argc, char** argv) {
  setenv("GRPC_VERBOSITY", "NONE", 0);       // errors are returned as statuses
  setenv("GRPC_DNS_RESOLVER", "native", 0);  // names as other programs resolve them (nsswitch.conf)
  // Debian's Abseil checks every lock for deadlocks, which costs 5 % of streaming; the tests keep the check.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  CLI::App app("phrenicd: simulates the breathing diaphragm and serves it to viewers and programs.", "phrenicd");
  Flags flags;
  std::function<int()> chosen;
  AddFlags(app, flags);
  AddCommands(app, flags, chosen);
  bool template_only = false;
  CLI::App* config = app.add_subcommand("config", "Print the settings in use and the origin of each");
  config->add_flag("--template", template_only, "print a settings file with all settings, their meanings and defaults");
  config->fallthrough();
  CLI::App* manual = app.add_subcommand("man", "Print the manual page");
  const std::string defaults = Template(app), page = ManualOf(app);
  const std::vector<std::string> words(argv + 1, argv + argc);
  const std::string file = ConfigFile(words);
  absl::StatusOr<std::set<std::string>> in_file = std::set<std::string>();
  if (!file.empty()) in_file = settings::ReadFile(file, app);
  if (!in_file.ok()) return Refuse(in_file.status());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kOk : kUsage;
  }
  if (config->parsed()) {
    std::cout << (template_only ? defaults : Describe(settings::SettingsOf(app, words, file, *in_file)));
    return kOk;
  }
  if (manual->parsed()) {
    std::cout << page;
    return kOk;
  }
  StartLog(flags.log);
  return chosen ? chosen() : Serve(flags);
}

}  // namespace
}  // namespace phrenic::daemon

int main(int argc, char** argv) { return phrenic::daemon::Main(argc, argv); }
