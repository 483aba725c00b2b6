#include "client/cli/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/completion.h"
#include "client/cli/help.h"
#include "client/cli/settings.h"
#include "client/cli/usage_error.h"
#include "client/print/output.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

int Refuse(const std::string& words) {
  std::cerr << ErrorName() << " " << words;
  return kUsage;
}

class CommandLine {
 public:
  explicit CommandLine(Interruption& interruption) {
    context_.interruption = &interruption;
    app_.description("Phrenic: the breathing diaphragm, simulated. Research and teaching; not for clinical use.");
    app_.formatter(std::make_shared<HelpFormatter>());
    app_.set_version_flag("--version", "phrenic " PHRENIC_VERSION, "print the version");
    app_.require_subcommand(1);
    app_.fallthrough();
    AddSettings();
    options_ = AddCommands(app_, context_, chosen_);
    ApplyKinds(app_);
  }

  int Run(Words words) {
    const auto in_file = ReadSettingsFile(SettingsFile(), app_);
    if (!in_file.ok()) return Refuse(absl::StrCat(in_file.status().message(), "\n"));
    if (!words.empty() && words[0] == kCompleteCommand) {
      PrintCandidates(app_, words.size() > 1 ? words[1] : "");
      return kOk;
    }
    if (!words.empty() && words[0] == "help") {  // people guess `phrenic help run`
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    const int code = Parse(words);
    if (!chosen_) return code;
    context_.settings = settings::SettingsOf(app_, words, SettingsFile(), *in_file);
    return RunChosen();
  }

 private:
  void AddSettings() {
    app_.add_option("--server", context_.server, "the server")->envname("PHRENIC_SERVER")->capture_default_str();
    app_.add_option("-o,--output", output_,
                    "table, for people; json, for programs; jsonl, a document a line, and csv, of what is a list")
        ->envname("PHRENIC_OUTPUT")
        ->capture_default_str();
    app_.add_option("--viewer", context_.viewer, "where links to the viewer lead, if not where the server says")
        ->envname("PHRENIC_VIEWER");
    app_.add_option("--tls-ca", context_.tls_ca, "authorities to trust, PEM; the system's where it is https://")
        ->envname("PHRENIC_TLS_CA");
    app_.add_option("--tls-cert", context_.tls_cert, "your own certificate, PEM, where the server asks for one")
        ->envname("PHRENIC_TLS_CERT");
    app_.add_option("--tls-key", context_.tls_key, "its key, PEM")->envname("PHRENIC_TLS_KEY");
    app_.add_option("--token-file", context_.token_file,
                    "file with your account's token, where the server asks for one")
        ->envname("PHRENIC_TOKEN_FILE");
    app_.add_flag_callback(
        "--no-color", [] { setenv("NO_COLOR", "1", 1); }, "no colours, as with NO_COLOR");
  }

  // Of help that was printed, or of an error; `chosen_` is empty then.
  int Parse(Words words) {
    const bool bare = words.empty();
    std::ranges::reverse(words);  // as CLI11 takes them
    try {
      app_.parse(words);
    } catch (const CLI::Success& success) {
      chosen_ = nullptr;
      return app_.exit(success);
    } catch (const CLI::ParseError& error) {
      chosen_ = nullptr;
      if (!bare) return Refuse(Explain(app_, error));
      std::cerr << ShortHelp(app_);
      return kUsage;
    }
    return kOk;
  }

  int RunChosen() {
    context_.settings_file = SettingsFile();
    context_.output = OutputOf(output_);
    const CLI::App* command = app_.get_subcommands().front();
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    for (const settings::Setting& setting : context_.settings) {
      if (setting.name == "server") context_.server_given = setting.origin != "default";
      if (setting.name != "output" || Knows(PathOf(*command), context_.output)) continue;
      if (setting.origin == "--output") {
        return Refuse(absl::StrCat("phrenic ", PathOf(*command), " gives no ", output_,
                                   ", which is for lists\n  try: --output json\n"));
      }
      // A preference, and not asked for now.
      context_.output = context_.output == Output::kJsonl ? Output::kJson : Output::kTable;
    }
    if (const absl::Status good = CheckConnection(context_); !good.ok()) return Fail(good);
    return chosen_();
  }

  Context context_;
  std::string output_ = "table";
  CLI::App app_{"", "phrenic"};
  std::function<int()> chosen_;
  std::shared_ptr<void> options_;
};

}  // namespace

int RunCommandLine(int argc, char** argv, Interruption& interruption) {
  return CommandLine(interruption).Run({argv + 1, argv + argc});
}

}  // namespace phrenic::client
