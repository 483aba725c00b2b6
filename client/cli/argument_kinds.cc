#include "client/cli/argument_kinds.h"

#include <algorithm>
#include <map>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/scene_argument.h"
#include "server/schema/fields.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

struct KindRow {
  const char* name;  // "ARGUMENT", or "COMMAND ARGUMENT" for one top-level command
  Kind kind;
  const char* placeholder;
  const char* choices;
};

// The first row that fits applies.
constexpr KindRow kKindRows[] = {
    {"--output", Kind::kChoice, "FORMAT", "table json jsonl csv"},
    {"phantom --field", Kind::kOther, "", ""},
    {"--field", Kind::kOther, "PATH", ""},
    {"--dicom", Kind::kChoice, "KIND,...", "seg ct stl obj all"},
    {"watch --at", Kind::kOther, "X,Y,Z", ""},
    {"--grid", Kind::kFile, "FILE", ""},
    {"--server", Kind::kOther, "HOST:PORT", ""},
    {"--viewer", Kind::kOther, "URL", ""},
    {"--tls-ca", Kind::kFile, "FILE", ""},
    {"--tls-cert", Kind::kFile, "FILE", ""},
    {"--tls-key", Kind::kFile, "FILE", ""},
    {"--token-file", Kind::kFile, "FILE", ""},
    {"--role", Kind::kChoice, "ROLE", "viewer controller"},
    {"SCENE", Kind::kScene, "", ""},
    {"SESSION", Kind::kSession, "", ""},
    {"--in-step-with", Kind::kSession, "SESSION", ""},
    {"EXPORT", Kind::kExport, "", ""},
    {"STUDY", Kind::kStudy, "", ""},
    {"SETTING", Kind::kSetting, "", ""},
    {"SHELL", Kind::kChoice, "", "bash zsh fish"},
    {"--set", Kind::kSetting, "NAME=VALUE", ""},
    {"--physique", Kind::kPhysique, "NAME=VALUE", ""},
    {"--preset", Kind::kPreset, "PRESET", ""},
    {"phantom --body", Kind::kChoice, "BODY", "adult small tall flat"},
    {"fluoroscopy --view", Kind::kChoice, "VIEW", "pa ap left-lateral lao-30 rao-30"},
    {"--body", Kind::kOther, "BODY", ""},
    {"--pull", Kind::kOther, "BODY:VERTEX:X,Y,Z", ""},
    {"--force", Kind::kOther, "X,Y,Z", ""},
    {"--id", Kind::kOther, "NAME", ""},
    {"--name", Kind::kOther, "NAME", ""},
    {"--web", Kind::kOther, "HOST:PORT", ""},
    {"study --check", Kind::kFile, "FILE", ""},
    {"physiology --check", Kind::kOther, "", ""},
    {"credibility --check", Kind::kOther, "", ""},
    {"--use", Kind::kFile, "FILE", ""},
    {"--exact", Kind::kFile, "FILE", ""},
    {"--orders", Kind::kFile, "FILE", ""},
    {"--convergence", Kind::kFile, "FILE", ""},
    {"--sensitivity", Kind::kFile, "FILE", ""},
    {"--uncertainty", Kind::kFile, "FILE", ""},
    {"--physiology", Kind::kFile, "FILE", ""},
    {"--evidence", Kind::kOther, "NAME=FILE", ""},
    {"--check", Kind::kOther, "MEASURE=LIMIT", ""},
    {"--codec", Kind::kOther, "CODEC", ""},
    {"calibrate --vary", Kind::kOther, "NAME[:LOW:HIGH]", ""},
    {"--vary", Kind::kOther, "NAME:LOW:HIGH", ""},
    {"watch --measure", Kind::kOther, "NAME", ""},
    {"--measure", Kind::kOther, "MEASURE[:STATISTIC]", ""},
    {"--repair", Kind::kChoice, "REPAIR,...", "weld cuts slivers fins orient pinches crumbs holes all"},
    {"patient --labels", Kind::kFile, "MAP or FILE=MAP", ""},
    {"--labels", Kind::kFile, "NAME or FILE", ""},
    {"phantom --out", Kind::kFile, "FILE or DIR", ""},
    {"patient --out", Kind::kFolder, "DIR", ""},
    {"register --surface", Kind::kFile, "NAME=FILE", ""},
    {"register --volume", Kind::kFile, "FILE", ""},
    {"--keep", Kind::kFolder, "DIR", ""},
    {"register --out", Kind::kFolder, "DIR", ""},
    {"campaign --out", Kind::kFolder, "DIR", ""},
    {"--on", Kind::kChoice, "WHERE", "here slurm"},
    {"--share", Kind::kOther, "I/N", ""},
    {"--data", Kind::kFolder, "DIR", ""},
    {"--spool", Kind::kFolder, "DIR", ""},
    {"--out", Kind::kFile, "FILE", ""},
    {"--export", Kind::kFile, "FILE", ""},
    {"--landmarks", Kind::kFile, "FILE[@PHASE]", ""},
    {"--exhale", Kind::kFile, "FILE", ""},
    {"fit --surface", Kind::kFile, "FILE[@WHEN]", ""},
    {"fit --lung-surface", Kind::kFile, "FILE[@WHEN]", ""},
    {"fit --volume", Kind::kFile, "FILE", ""},
    {"fit --m-mode", Kind::kFile, "FILE[@SIDE]", ""},
    {"fit --markers", Kind::kFile, "FILE", ""},
    {"fit --error", Kind::kOther, "KIND=VALUE", ""},
    {"--residuals", Kind::kFile, "FILE", ""},
    {"--expected", Kind::kFile, "FILE", ""},
    {"--cases", Kind::kFolder, "DIR", ""},
    {"--modes", Kind::kChoice, "COUNT", "8 12"},
    {"--page", Kind::kFile, "FILE", ""},
    {"--junit", Kind::kFile, "FILE", ""},
    {"--scene", Kind::kScene, "SCENE", ""},
    {"--map", Kind::kFile, "FILE", ""},
    {"FILE", Kind::kFile, "", ""},
    {"VOLUME", Kind::kFile, "", ""},
    {"IN", Kind::kFile, "", ""},
    {"OUT", Kind::kFile, "", ""},
    {"A", Kind::kFile, "", ""},
    {"B", Kind::kFile, "", ""},
};

// True if the row applies to the argument. "study --check" applies to "study error" too.
bool Fits(const KindRow& row, absl::string_view path, absl::string_view name) {
  absl::string_view command = row.name;  // asked for each option of each command at the start: allocates nothing
  if (!absl::ConsumeSuffix(&command, name)) return false;
  return command.empty() || (absl::ConsumeSuffix(&command, " ") && command == path.substr(0, path.find(' ')));
}

void ApplyTo(const CLI::App& command, CLI::Option& option) {
  const ArgumentKind kind = KindOf(command, option);
  if (!kind.placeholder.empty()) option.type_name(kind.placeholder);
  if (kind.kind == Kind::kSetting) {
    option.check(ParsedBy([](const std::string& text) { return ReadSettings({text}).status(); }), "");
  }
  if (kind.kind == Kind::kPhysique) {
    option.check(ParsedBy([](const std::string& text) { return ReadPhysique({text}).status(); }), "");
  }
  if (kind.kind != Kind::kChoice) return;
  const auto check = [choices = kind.choices](const std::string& value) {
    if (std::ranges::find(choices, value) != choices.end()) return std::string();
    return absl::StrCat("there is no \"", value, "\"", schema::ThereAre(value, choices));
  };
  option.check(check, "");
}

// Returns the part of an argument that only one argument of its option may have, such as NAME of NAME=VALUE; empty if
// the option has no such part.
std::string OnlyOnce(const ArgumentKind& kind, const std::string& text) {
  if (kind.placeholder == "BODY:VERTEX:X,Y,Z") return text.substr(0, text.rfind(':'));
  const bool named = kind.kind == Kind::kSetting || absl::StrContains(kind.placeholder, '=');
  if (named) return text.find('=') == std::string::npos ? "" : text.substr(0, text.find('='));
  const bool ranged = absl::StartsWith(kind.placeholder, "NAME:") || absl::StartsWith(kind.placeholder, "NAME[:");
  return ranged ? text.substr(0, text.find(':')) : "";
}

}  // namespace

void CheckNamesOnce(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const ArgumentKind kind = KindOf(command, *option);
    std::map<std::string, std::string> seen;  // by name
    for (const std::string& text : option->results()) {
      const std::string name = OnlyOnce(kind, text);
      const auto [first, added] = seen.emplace(name, text);
      if (added || name.empty()) continue;
      throw CLI::ValidationError(NameOf(*option), absl::StrCat(name, " is given twice, as ", first->second, " and as ",
                                                               text, "; give it once"));
    }
  }
  for (const CLI::App* below : command.get_subcommands()) CheckNamesOnce(*below);
}

CLI::Validator NumberIn(double low, double high) {
  v1::Quantity quantity;
  quantity.set_unit("1");
  quantity.set_minimum(low);
  quantity.set_maximum(high);
  const std::string range = schema::FormatRange(quantity);
  const auto check = [quantity, range](std::string& text) {
    double value = 0;
    if (!absl::SimpleAtod(text, &value)) return absl::StrCat("\"", text, "\" is not a number; allowed is ", range);
    return schema::NumberProblem(value, &quantity).value_or("");
  };
  return CLI::Validator(check, absl::StrCat(" in [", range, "]"));
}

CLI::Validator ParsedBy(std::function<absl::Status(const std::string&)> parse) {
  const auto check = [parse = std::move(parse)](std::string& text) { return std::string(parse(text).message()); };
  return {check, ""};
}

std::string NameOf(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true) : option.get_name();
}

std::string PathOf(const CLI::App& command) {
  if (command.get_parent() == nullptr) return "";
  const std::string before = PathOf(*command.get_parent());
  return before.empty() ? command.get_name() : absl::StrCat(before, " ", command.get_name());
}

ArgumentKind KindOf(const CLI::App& command, const CLI::Option& option) {
  const std::string path = PathOf(command), name = NameOf(option);
  for (const KindRow& row : kKindRows) {
    if (!Fits(row, path, name)) continue;
    return {row.kind, row.placeholder, absl::StrSplit(row.choices, ' ', absl::SkipEmpty())};
  }
  return {};
}

void ApplyKinds(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) ApplyTo(command, *option);
  for (CLI::App* below : command.get_subcommands({})) ApplyKinds(*below);
}

}  // namespace phrenic::client
