// Columns: aligned for people, two spaces apart, numbers to the right; or CSV (RFC 4180).
#ifndef PHRENIC_CLIENT_PRINT_TABLE_H_
#define PHRENIC_CLIENT_PRINT_TABLE_H_

#include <ostream>
#include <string>
#include <vector>

namespace phrenic::client {

// One line of CSV; cells with a comma, a quote or a line break stand in quotes.
void PrintCsvLine(const std::vector<std::string>& cells, std::ostream& out);

class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  // As many cells as the header has.
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.empty(); }
  // On a terminal the header stands out, and the last column is broken into lines where it does not fit.
  void Print(std::ostream& out) const;
  // In `width` columns of text; 0: any number.
  void Print(std::ostream& out, int width) const;
  void PrintCsv(std::ostream& out) const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_TABLE_H_
