#include "client/print/table.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "absl/strings/str_replace.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

constexpr int kGap = 2, kNarrowest = 24;  // a narrower last column is not wrapped

bool IsNumber(const std::string& cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789.+-e") == std::string::npos && cell != "-" && cell != "e";
}

std::string Padded(const std::string& cell, int width) {
  const std::string space(std::max(0, width - ColumnsOf(cell)), ' ');
  return IsNumber(cell) ? space + cell : cell + space;
}

std::string RowText(const std::vector<std::string>& row, const std::vector<int>& widths, int width) {
  std::string line;
  if (row.empty()) return line;
  for (size_t c = 0; c + 1 < row.size(); ++c) line += Padded(row[c], widths[c]) + std::string(kGap, ' ');
  const int at = ColumnsOf(line);
  const bool wrap = width - at >= kNarrowest && ColumnsOf(row.back()) > width - at;
  line += wrap ? Wrapped(row.back(), width, at) : Padded(row.back(), widths.back());
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

void PrintCsvLine(const std::vector<std::string>& cells, std::ostream& out) {
  for (size_t i = 0; i < cells.size(); ++i) {
    const bool quoted = cells[i].find_first_of(",\"\n\r") != std::string::npos;
    out << (i == 0 ? "" : ",");
    if (quoted) {
      out << '"' << absl::StrReplaceAll(cells[i], {{"\"", "\"\""}}) << '"';
    } else {
      out << cells[i];
    }
  }
  out << "\n";
}

void Table::Print(std::ostream& out) const {
  Print(out, &out == &std::cout && IsTerminal(STDOUT_FILENO) ? WidthOf(STDOUT_FILENO) : 0);
}

void Table::Print(std::ostream& out, int width) const {
  std::vector<int> widths;
  for (const std::string& cell : header_) widths.push_back(ColumnsOf(cell));
  for (const auto& row : rows_) {
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], ColumnsOf(row[c]));
  }
  const std::string header = RowText(header_, widths, 0);
  out << (&out == &std::cout ? Painted(header, Ink::kBold, STDOUT_FILENO) : header) << "\n";
  for (const auto& row : rows_) out << RowText(row, widths, width) << "\n";
}

void Table::PrintCsv(std::ostream& out) const {
  PrintCsvLine(header_, out);
  for (const auto& row : rows_) PrintCsvLine(row, out);
}

}  // namespace phrenic::client
