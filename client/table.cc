#include "client/table.h"

#include <algorithm>

namespace phrenic::client {
namespace {

bool IsNumber(const std::string& cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789.+-e") == std::string::npos && cell != "-" && cell != "e";
}

std::string Padded(const std::string& cell, size_t width) {
  const std::string space(width - cell.size(), ' ');
  return IsNumber(cell) ? space + cell : cell + space;
}

void PrintRow(const std::vector<std::string>& row, const std::vector<size_t>& widths, std::ostream& out) {
  std::string line;
  for (size_t c = 0; c < row.size(); ++c) line += (c == 0 ? "" : "  ") + Padded(row[c], widths[c]);
  line.erase(line.find_last_not_of(' ') + 1);
  out << line << "\n";
}

}  // namespace

void Table::Print(std::ostream& out) const {
  std::vector<size_t> widths;
  for (const std::string& cell : header_) widths.push_back(cell.size());
  for (const auto& row : rows_) {
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  PrintRow(header_, widths, out);
  for (const auto& row : rows_) PrintRow(row, widths, out);
}

}  // namespace phrenic::client
