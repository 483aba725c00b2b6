// phrenicd: settings -> options -> serve until a signal comes, or one of its commands.
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
  setenv("GRPC_VERBOSITY", "NONE", 0);  // what matters of it comes as a status
  // Debian's Abseil looks for deadlocks at every lock, a twentieth of what sending costs; the tests have it look.
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
  CLI::App app("phrenicd: simulates the breathing diaphragm and serves it to viewers and programs.", "phrenicd");
  Flags flags;
  std::function<int()> chosen;
  AddFlags(app, flags);
  AddCommands(app, flags, chosen);
  bool with_meanings = false;
  CLI::App* config = app.add_subcommand("config", "Say what settings hold, and where each comes from");
  config->add_flag("--template", with_meanings, "a file of all settings with their meanings and defaults instead");
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
    std::cout << (with_meanings ? defaults : Describe(settings::SettingsOf(app, words, file, *in_file)));
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
