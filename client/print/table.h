// A table of text cells, printed in aligned columns or as CSV (RFC 4180).
#ifndef PHRENIC_CLIENT_PRINT_TABLE_H_
#define PHRENIC_CLIENT_PRINT_TABLE_H_

#include <ostream>
#include <string>
#include <vector>

namespace phrenic::client {

// Prints one line of CSV. Cells with a comma, a quote or a line break are quoted.
void PrintCsvLine(const std::vector<std::string>& cells, std::ostream& out);

// Columns are two spaces apart; numbers are aligned to the right. Not thread-safe. A number is a cell of digits, signs,
// points and "e".
class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  // Requires: one cell per column of the header.
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.empty(); }
  // Prints for people. On a terminal the header is bold and the last column is wrapped to the terminal's width. The
  // terminal is standard output; other streams get the text without a limit of width.
  void Print(std::ostream& out) const;
  // Wraps the last column to `width` columns of text; 0: no limit. If fewer than 24 columns are left for it, it is not
  // wrapped.
  void Print(std::ostream& out, int width) const;
  // The header comes first.
  void PrintCsv(std::ostream& out) const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_TABLE_H_
