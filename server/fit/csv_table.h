// A CSV of named columns: a header, then one line per row. Quotes have no meaning; lines that begin with # are
// comments.
#ifndef PHRENIC_SERVER_FIT_CSV_TABLE_H_
#define PHRENIC_SERVER_FIT_CSV_TABLE_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/meshio/text.h"

namespace phrenic::fit {

// Reads row by row; copies nothing but the header. `name` and `bytes` must outlive it. Not thread-safe.
class CsvTable {
 public:
  CsvTable(std::string_view name, std::string_view bytes) : reader_(name, bytes) {}

  // Reads the comments and the header. INVALID_ARGUMENT "name: ..." if the file has no header.
  absl::Status ReadHeader();
  // The header's names, in lower case.
  const std::vector<std::string>& names() const { return names_; }
  // The text of the comments before the header.
  const std::string& comments() const { return comments_; }
  // Returns the index of the first column with one of these names, or -1.
  int Find(std::initializer_list<std::string_view> names) const;

  // Moves to the next row. Returns false after the last one.
  bool Next();
  // Returns the text of a cell of the row; empty if the row is too short.
  std::string_view Text(int column) const;
  // Reads a cell's number. INVALID_ARGUMENT "name:line: ..." if it is not a finite number or is missing.
  absl::Status Read(int column, double& number) const;
  // Returns INVALID_ARGUMENT "name:line: message".
  absl::Status Error(const std::string& message) const { return reader_.Error(message); }

 private:
  meshio::TextReader reader_;
  std::vector<std::string> names_;
  std::vector<std::string_view> cells_;
  std::string comments_;
};

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_CSV_TABLE_H_
