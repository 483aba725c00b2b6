#include "client/cli/guide.h"

#include <algorithm>

#include "server/schema/names.h"

namespace phrenic::client {
namespace {

constexpr Example kFirst[] = {
    {"phrenic run thorax --seconds 8", "simulate in this process; needs no server"},
    {"phrenic create thorax --play", "create a session on the server; prints the viewer's link"},
    {"phrenic watch thorax", "watch its breath live in the terminal"},
    {"phrenic set thorax breath_force=2", "change a parameter while it runs"},
    {"phrenic export thorax out.pvd --seconds 4", "write its motion to a file"},
    {"phrenic doctor", "check the installation and the server"},
};

constexpr NamedText kExitCodes[] = {
    {"0", "success"},
    {"1", "failure: what was asked for could not be done"},
    {"2", "invalid input: the command line, the environment, the settings file, or a file that they name"},
    {"3", "no server"},
    {"4",
     "a limit is exceeded, a replay ends in another state, a calibration reaches no such breath, or a required section "
     "of "
     "a credibility report is not met"},
    {"5", "not permitted: another user controls the session, or the account lacks the right"},
    {"130", "interrupted"},
};

constexpr NamedText kVariables[] = {
    {"PHRENIC_SERVER", "HOST:PORT of the server, like --server"},
    {"PHRENIC_TLS_CA", "like --tls-ca"},
    {"PHRENIC_TLS_CERT", "like --tls-cert"},
    {"PHRENIC_TLS_KEY", "like --tls-key"},
    {"PHRENIC_TOKEN_FILE", "like --token-file"},
    {"PHRENIC_TOKEN", "the account's token"},
    {"PHRENIC_JOIN", "the text after #join= in a link to a session"},
    {"PHRENIC_OUTPUT", "like --output"},
    {"PHRENIC_VIEWER", "like --viewer"},
    {"PHRENIC_DATA", "like --data"},
    {"PHRENIC_CONFIG", "path of the settings file"},
    {"NO_COLOR", "if set: no colours"},
    {"XDG_CONFIG_HOME", "folder of settings (~/.config)"},
    {"XDG_STATE_HOME", "folder of control tokens (~/.local/state)"},
};

struct Synonym {
  std::string_view word;
  const char* command;
};
constexpr Synonym kSynonyms[] = {
    {"ls", "sessions"},       {"list", "sessions"},      {"ps", "sessions"},
    {"start", "play"},        {"resume", "play"},        {"stop", "pause"},
    {"rm", "delete"},         {"remove", "delete"},      {"kill", "delete"},
    {"new", "create"},        {"open", "create"},        {"add", "create"},
    {"info", "describe"},     {"show", "describe"},      {"view", "watch"},
    {"follow", "watch"},      {"get", "exports get"},    {"download", "exports get"},
    {"save", "export"},       {"status", "doctor"},      {"check", "doctor"},
    {"version", "--version"}, {"diff", "compare"},       {"distance", "compare"},
    {"clone", "fork"},        {"copy", "fork"},          {"simulate", "run"},
    {"parameters", "set"},    {"breathe", "physiology"}, {"completions", "completion"},
    {"tune", "calibrate"},    {"learn", "--help"},       {"tutorial", "--help"},
    {"help", "--help"},
};

}  // namespace

std::span<const Example> FirstExamples() { return kFirst; }
std::span<const NamedText> ExitCodes() { return kExitCodes; }
std::span<const NamedText> EnvironmentVariables() { return kVariables; }

std::string SettingsText() {
  return "A setting is read from the command line, else from the environment, else from the settings file; else it has "
         "its default. `phrenic doctor` shows the origin of each. The file is $XDG_CONFIG_HOME/phrenic/config.toml. It "
         "names options without dashes; options of one command are below its name in brackets.";
}

std::string CommandMeantBy(std::string_view word, std::vector<std::string> commands) {
  const auto meaning = [](std::string_view name) { return std::ranges::find(kSynonyms, name, &Synonym::word); };
  if (const auto found = meaning(word); found != std::end(kSynonyms)) return found->command;
  for (const Synonym& synonym : kSynonyms) commands.emplace_back(synonym.word);
  const std::string nearest = schema::NearestName(word, commands);
  const auto found = meaning(nearest);
  return found == std::end(kSynonyms) ? nearest : found->command;
}

}  // namespace phrenic::client
