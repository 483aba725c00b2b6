// Columns of text for people: aligned, two spaces apart, numbers to the right.
#ifndef PHRENIC_CLIENT_TABLE_H_
#define PHRENIC_CLIENT_TABLE_H_

#include <ostream>
#include <string>
#include <vector>

namespace phrenic::client {

class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  // As many cells as the header has.
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  bool empty() const { return rows_.empty(); }
  void Print(std::ostream& out) const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TABLE_H_
