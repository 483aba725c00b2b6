#include "server/fit/csv_table.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/fit/csv_cells.h"

namespace phrenic::fit {
namespace {

constexpr size_t kMostColumns = 8000;  // three of each of 2,000 markers, and others

}  // namespace

absl::Status CsvTable::ReadHeader() {
  while (reader_.NextFilledLine()) {
    if (reader_.Rest().front() == '#') {
      absl::StrAppend(&comments_, absl::AsciiStrToLower(std::string(reader_.Rest())), "\n");
      continue;
    }
    const auto cells = CellsOf(reader_.Rest());
    if (cells.size() > kMostColumns) {
      return reader_.Error(absl::StrCat("the header has ", cells.size(), " columns, more than ", kMostColumns));
    }
    for (const std::string_view cell : cells) {
      names_.push_back(absl::AsciiStrToLower(std::string(cell)));
    }
    return absl::OkStatus();
  }
  return reader_.Error("the file has no line: its first one names the columns");
}

int CsvTable::Find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
  }
  return -1;
}

bool CsvTable::Next() {
  while (reader_.NextFilledLine()) {
    if (reader_.Rest().front() == '#') continue;
    cells_ = CellsOf(reader_.Rest());
    return true;
  }
  return false;
}

std::string_view CsvTable::Text(int column) const {
  const auto at = static_cast<size_t>(column);
  return at < cells_.size() ? cells_[at] : std::string_view();
}

absl::Status CsvTable::Read(int column, double& number) const {
  const auto at = static_cast<size_t>(column);
  if (at >= cells_.size()) {
    return Error(absl::StrCat("column ", column + 1, ", ", meshio::Quoted(names_[at]), ", is missing: this line has ",
                              cells_.size()));
  }
  if (meshio::ParseNumber(cells_[at], number)) return absl::OkStatus();
  return Error(absl::StrCat(meshio::Quoted(cells_[at]), " in column ", column + 1, ", ", meshio::Quoted(names_[at]),
                            ", is not a finite number"));
}

}  // namespace phrenic::fit
