#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

using Graph = std::map<std::string, std::set<std::string>>;  // from -> to

std::set<std::string> QuotedIncludes(const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*"([^"]+)")re");
  std::set<std::string> headers;
  std::istringstream lines{text};
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, match, include)) headers.insert(match[1]);
  }
  return headers;
}

std::string ParentFolder(const std::string& path) { return path.substr(0, path.rfind('/')); }

// Depth-first search that records the first path back to a node that is still open.
class CycleSearch {
 public:
  explicit CycleSearch(const Graph& graph) : graph_(graph) {}

  std::vector<std::vector<std::string>> Find() {
    for (const auto& [node, next] : graph_) Visit(node);
    return cycles_;
  }

 private:
  void Visit(const std::string& node) {
    if (done_.contains(node)) return;
    if (const auto open = std::find(path_.begin(), path_.end(), node); open != path_.end()) {
      cycles_.emplace_back(open, path_.end());
      return;
    }
    path_.push_back(node);
    if (const auto next = graph_.find(node); next != graph_.end()) {
      for (const std::string& to : next->second) Visit(to);
    }
    path_.pop_back();
    done_.insert(node);
  }

  const Graph& graph_;
  std::vector<std::string> path_;
  std::set<std::string> done_;
  std::vector<std::vector<std::string>> cycles_;
};

void AppendCycles(const Graph& graph, const std::string& kind, Faults& faults) {
  for (const auto& cycle : CycleSearch(graph).Find()) {
    std::string fault = cycle.front() + ": include cycle between " + kind + ": ";
    for (const std::string& node : cycle) fault += node + " -> ";
    faults.push_back(fault + cycle.front());
  }
}

}  // namespace

std::string UnitOf(std::string_view path) {
  static const std::regex ending(R"((-inl)?\.(cc|h|ts)$)");
  return std::regex_replace(std::string(path), ending, "");
}

Faults CycleFaults(const Texts& texts) {
  Graph units, folders;
  for (const auto& [path, text] : texts) {
    for (const std::string& header : QuotedIncludes(text)) {
      if (!texts.contains(header)) continue;
      if (UnitOf(header) != UnitOf(path)) units[UnitOf(path)].insert(UnitOf(header));
      if (ParentFolder(header) != ParentFolder(path)) folders[ParentFolder(path)].insert(ParentFolder(header));
    }
  }
  Faults faults;
  AppendCycles(units, "files", faults);
  AppendCycles(folders, "folders", faults);
  return faults;
}

Faults FolderSizeFaults(const std::vector<std::string>& paths) {
  std::map<std::string, std::set<std::string>> units;
  for (const std::string& path : paths) units[ParentFolder(path)].insert(UnitOf(path));
  Faults faults;
  for (const auto& [folder, members] : units) {
    if (members.size() <= kLargestFolder) continue;
    faults.push_back(folder + ": " + std::to_string(members.size()) + " units; group them into subfolders, " +
                     std::to_string(kLargestFolder) + " is the most");
  }
  return faults;
}

}  // namespace phrenic::architecture
