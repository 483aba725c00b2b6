#include <regex>
#include <sstream>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

// "mechanics" of "[`mechanics/`](mechanics/README.md)".
std::string FolderName(const std::string& cell) {
  static const std::regex name(R"(`([a-z_]+)(/|\.cc)?`)");
  std::smatch match;
  return std::regex_search(cell, match, name) ? match[1].str() : "";
}

std::vector<std::string> CellsOf(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream text(row.substr(1));
  for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
  return cells;
}

std::set<std::string> NamesIn(const std::string& cell) {
  static const std::regex name(R"(`([a-z_]+)`)");
  std::set<std::string> names;
  for (std::sregex_iterator i(cell.begin(), cell.end(), name), end; i != end; ++i) names.insert((*i)[1]);
  return names;
}

}  // namespace

Directions DirectionsOf(std::string_view readme) {
  Directions directions;
  std::istringstream lines{std::string(readme)};
  bool in_table = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| folder |")) in_table = true;
    if (!line.starts_with('|')) in_table = false;
    const std::vector<std::string> cells = in_table ? CellsOf(line) : std::vector<std::string>();
    if (cells.size() < 3) continue;
    const std::string folder = FolderName(cells[0]);
    if (!folder.empty()) directions[folder] = NamesIn(cells[2]);
  }
  return directions;
}

}  // namespace phrenic::architecture
