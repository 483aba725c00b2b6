// The layers of client/: includes follow the table in client/README.md, and no file includes itself through others.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <regex>
#include <set>

#include "absl/strings/str_split.h"
#include "client/cli/guide.h"
#include "tests/client/programs.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

// Returns the folders that each folder of client/ may include, from the table of client/README.md.
std::map<std::string, Names> AllowedIncludes() {
  std::map<std::string, Names> allowed;
  const std::regex row(R"(^\| `(\w+)/` \|[^|]*\| ([^|]*) \|$)"), name("`(\\w+)`");
  std::smatch cells;
  for (const std::string& line :
       std::vector<std::string>(absl::StrSplit(ReadAll(std::string(PHRENIC_SOURCE_DIR) + "/client/README.md"), '\n'))) {
    if (!std::regex_match(line, cells, row)) continue;
    Names& folders = allowed[cells[1]];
    const std::string list = cells[2];
    for (std::sregex_iterator found(list.begin(), list.end(), name), end; found != end; ++found) {
      folders.insert((*found)[1]);
    }
  }
  return allowed;
}

// Returns "client/cli/help" for client/cli/help.cc and client/cli/help.h: a unit.
std::string UnitOf(const std::string& path) { return path.substr(0, path.rfind('.')); }

// Returns "cli" for client/cli/help; empty for client/main.
std::string FolderOf(const std::string& unit) {
  const std::vector<std::string> parts = absl::StrSplit(unit, '/');
  return parts.size() == 3 ? parts[1] : "";
}

// Returns the units of client/ that each unit includes.
std::map<std::string, Names> IncludesOfUnits() {
  std::map<std::string, Names> includes;
  const std::regex include(R"re(#include "(client/[^"]+)")re");
  for (const auto& file : fs::recursive_directory_iterator(fs::path(PHRENIC_SOURCE_DIR) / "client")) {
    if (file.path().extension() != ".cc" && file.path().extension() != ".h") continue;
    const std::string unit = UnitOf(fs::relative(file.path(), PHRENIC_SOURCE_DIR));
    const std::string text = ReadAll(file.path());
    for (std::sregex_iterator found(text.begin(), text.end(), include), end; found != end; ++found) {
      if (UnitOf((*found)[1]) != unit) includes[unit].insert(UnitOf((*found)[1]));
    }
  }
  return includes;
}

TEST(Layers, IncludesFollowTheTableOfTheReadme) {
  auto allowed = AllowedIncludes();
  ASSERT_GE(allowed.size(), 7U);
  for (const auto& [unit, includes] : IncludesOfUnits()) {
    const std::string folder = FolderOf(unit);
    if (folder.empty()) continue;  // main.cc
    ASSERT_TRUE(allowed.contains(folder)) << folder << "/ has no row in client/README.md";
    for (const std::string& included : includes) {
      EXPECT_TRUE(FolderOf(included) == folder || allowed[folder].contains(FolderOf(included)))
          << unit << " includes " << included;
    }
  }
}

TEST(Layers, NoUnitIncludesItselfThroughOthers) {
  const auto includes = IncludesOfUnits();
  Names open, done;
  const std::function<void(const std::string&)> visit = [&](const std::string& unit) {
    if (done.contains(unit)) return;
    EXPECT_TRUE(open.insert(unit).second) << unit << " includes itself through others";
    if (const auto found = includes.find(unit); found != includes.end()) {
      for (const std::string& next : found->second) {
        if (!open.contains(next) || done.contains(next)) visit(next);
        EXPECT_TRUE(done.contains(next)) << "cycle: " << unit << " and " << next;
      }
    }
    done.insert(unit);
  };
  for (const auto& [unit, unused] : includes) visit(unit);
}

TEST(ReadmeOfTheClient, HasTheExitCodesOfTheHelp) {
  std::map<std::string, std::string> rows, known;
  const std::regex row(R"(^\| (\d+) \| (.*) \|$)");
  std::smatch cells;
  for (const std::string& line :
       std::vector<std::string>(absl::StrSplit(ReadAll(std::string(PHRENIC_SOURCE_DIR) + "/client/README.md"), '\n'))) {
    if (std::regex_match(line, cells, row)) rows[cells[1]] = cells[2];
  }
  for (const NamedText& code : ExitCodes()) known[code.name] = code.meaning;
  EXPECT_EQ(rows, known);
}

}  // namespace
}  // namespace phrenic::client
