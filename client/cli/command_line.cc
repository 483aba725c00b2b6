#include "client/cli/command_line.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "absl/strings/str_cat.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/completion.h"
#include "client/cli/help.h"
#include "client/cli/settings.h"
#include "client/cli/usage_error.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/field.h"
#include "client/print/output.h"
#include "server/settings/settings_file.h"

namespace phrenic::client {
namespace {

using Words = std::vector<std::string>;

int FailUsage(const std::string& message) {
  std::cerr << ErrorPrefix() << " " << message;
  return kUsage;
}

class CommandLine {
 public:
  CommandLine(CommandTable commands, Interruption& interruption) : commands_(commands) {
    context_.interruption = &interruption;
    app_.description("Phrenic simulates the breathing diaphragm. For research and teaching; not for clinical use.");
    app_.formatter(std::make_shared<HelpFormatter>(commands));
    app_.set_version_flag("--version", "phrenic " PHRENIC_VERSION, "print the version");
    app_.require_subcommand(1);
    app_.fallthrough();
    AddSettings();
    AddCommands(commands, app_, chosen_);
    ApplyKinds(app_);
  }

  int Run(Words words) {
    const auto in_file = ReadSettingsFile(SettingsFile(), app_);
    if (!in_file.ok()) return FailUsage(absl::StrCat(in_file.status().message(), "\n"));
    if (!words.empty() && words[0] == kCompleteCommand) {
      PrintCandidates(app_, words.size() > 1 ? words[1] : "");
      return kOk;
    }
    if (!words.empty() && words[0] == "help") {  // `phrenic help run` means `phrenic run --help`
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
    app_.add_option("--server", context_.server, "address of the server")
        ->envname("PHRENIC_SERVER")
        ->capture_default_str();
    app_.add_option("-o,--output", output_,
                    "table for people, json for programs; lists also as csv, and as jsonl (one JSON document per line)")
        ->envname("PHRENIC_OUTPUT")
        ->capture_default_str();
    app_.add_option("--field", field_, "print only this value of the JSON: session.tick, sessions.0.id, sessions.*.id");
    app_.add_option("--viewer", context_.viewer,
                    "address of the viewer in links, if not the one that the server reports")
        ->envname("PHRENIC_VIEWER");
    app_.add_option("--tls-ca", context_.tls_ca,
                    "trusted certificate authorities, PEM; default for https://: the system's")
        ->envname("PHRENIC_TLS_CA");
    app_.add_option("--tls-cert", context_.tls_cert, "client certificate, PEM, if the server requires one")
        ->envname("PHRENIC_TLS_CERT");
    app_.add_option("--tls-key", context_.tls_key, "key of the client certificate, PEM")->envname("PHRENIC_TLS_KEY");
    app_.add_option("--token-file", context_.token_file, "file with the account's token, if the server requires one")
        ->envname("PHRENIC_TOKEN_FILE");
    app_.add_flag_callback(
        "--no-color", [] { setenv("NO_COLOR", "1", 1); }, "print without colours, like NO_COLOR");
  }

  // Sets `chosen_`, or prints help or an error, clears `chosen_` and returns the exit code.
  int Parse(Words words) {
    const bool bare = words.empty();
    std::ranges::reverse(words);  // CLI11 takes the last word first
    try {
      app_.parse(words);
      CheckNamesOnce(app_);
    } catch (const CLI::Success& success) {
      chosen_ = nullptr;
      return app_.exit(success);
    } catch (const CLI::ParseError& error) {
      chosen_ = nullptr;
      if (!bare) return FailUsage(Explain(app_, commands_, error));
      std::cerr << ShortHelp(app_);
      return kUsage;
    }
    return kOk;
  }

  int RunChosen() {
    context_.settings_file = SettingsFile();
    context_.output = OutputOf(output_);
    if (!field_.empty() && context_.output != Output::kJsonl) context_.output = Output::kJson;
    const CLI::App* command = app_.get_subcommands().front();
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const Command& row = *FindCommand(commands_, PathOf(*command));
    for (const settings::Setting& setting : context_.settings) {
      if (setting.name == "server") context_.server_given = setting.origin != "default";
      if (setting.origin == "--output" && !field_.empty() && output_ == "csv") {
        return FailUsage("--field reads JSON, not CSV\n  try: without --output\n");
      }
      if (setting.name != "output" || Supports(row, context_.output)) continue;
      if (setting.origin == "--output") {
        return FailUsage(absl::StrCat("phrenic ", PathOf(*command), " has no output as ", output_,
                                      ", which is for lists\n  try: --output json\n"));
      }
      // A setting that the command does not support is only a preference.
      context_.output = context_.output == Output::kJsonl ? Output::kJson : Output::kTable;
    }
    if (const absl::Status good = CheckConnection(context_); !good.ok()) return Fail(good);
    return field_.empty() ? chosen_(context_) : PrintChosenField();
  }

  int PrintChosenField() {
    int code = kOk;
    const auto command = [&] { code = chosen_(context_); };
    const absl::Status printed = PrintField(std::cout, field_, context_.output == Output::kJsonl, command);
    return printed.ok() ? code : FailUsage(absl::StrCat(printed.message(), "\n"));
  }

  const CommandTable commands_;
  Context context_;
  std::string output_ = "table";
  std::string field_;  // path of the value to print; empty: all
  CommandFunction chosen_;
  CLI::App app_{"", "phrenic"};
};

}  // namespace

int RunCommandLine(const std::vector<std::string>& words, CommandTable commands, Interruption& interruption) {
  return CommandLine(commands, interruption).Run(words);
}

}  // namespace phrenic::client
