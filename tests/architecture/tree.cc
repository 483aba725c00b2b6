#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

namespace fs = std::filesystem;

// True for dependencies, build outputs and generated code.
bool IsMade(const fs::path& folder) {
  static const std::set<std::string> made = {"node_modules", "dist", "gen", "out", ".git", ".cache"};
  return made.contains(folder.filename().string()) || folder.filename().string().starts_with("build");
}

std::string Read(const fs::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

bool IsCode(const std::string& path) {
  static const std::set<std::string> endings = {".cc", ".h", ".ts", ".css", ".html", ".proto", ".sh", ".bats", ".py"};
  return endings.contains(fs::path(path).extension().string()) || path.starts_with("deploy/") ||
         path == "CMakeLists.txt";
}

bool IsCpp(const std::string& path) { return path.ends_with(".cc") || path.ends_with(".h"); }

template <typename Visit>
void ForEachEntry(const fs::path& root, const Visit& visit) {
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory() && IsMade(entry->path())) {
      entry.disable_recursion_pending();
      continue;
    }
    visit(*entry, entry->path().lexically_relative(root).generic_string());
  }
}

void Append(Faults& all, Faults some) { std::move(some.begin(), some.end(), std::back_inserter(all)); }

}  // namespace

Faults LengthFaults(std::string_view path, std::string_view text) {
  const auto lines = std::count(text.begin(), text.end(), '\n');
  if (lines <= kLongestFile) return {};
  return {std::string(path) + ": " + std::to_string(lines) + " lines; split it, " + std::to_string(kLongestFile) +
          " is the most"};
}

Faults TreeFaults(const fs::path& root) {
  static const std::set<std::string> top = {
      "CMakeLists.txt", "proto", "server", "client", "web", "tests", "deploy", "README.md", "compile_commands.json"};
  static const std::set<std::string> vague = {"util", "utils", "common", "helper", "helpers", "misc"};
  Faults faults;
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (top.contains(name) || name.starts_with(".") || IsMade(entry.path())) continue;
    faults.push_back(name + ": does not belong at the top; see the map in server/README.md");
  }
  ForEachEntry(root, [&](const fs::directory_entry& entry, const std::string& path) {
    if (entry.is_directory() && vague.contains(entry.path().filename().string())) {
      faults.push_back(path + ": call the folder by what is in it");
    }
  });
  return faults;
}

Faults AllFaults(const fs::path& root) {
  Faults faults = TreeFaults(root);
  const Directions directions = DirectionsOf(Read(root / "server" / "README.md"));
  Texts cpp;
  std::vector<std::string> units;
  ForEachEntry(root, [&](const fs::directory_entry& entry, const std::string& path) {
    if (!entry.is_regular_file() || !IsCode(path)) return;
    std::string text = Read(entry.path());
    Append(faults, LengthFaults(path, text));
    Append(faults, ImportFaults(path, text));
    if (IsCpp(path) || path.ends_with(".ts")) units.push_back(path);
    if (!IsCpp(path)) return;
    Append(faults, IncludeFaults(directions, path, text));
    Append(faults, FunctionFaults(path, text));
    cpp.emplace(path, std::move(text));
  });
  Append(faults, CycleFaults(cpp));
  Append(faults, FolderSizeFaults(units));
  return faults;
}

}  // namespace phrenic::architecture
