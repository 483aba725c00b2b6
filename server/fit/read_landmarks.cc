#include "server/fit/read_landmarks.h"

#include <algorithm>
#include <array>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/fit/csv_cells.h"
#include "server/fit/slicer_points.h"
#include "server/meshio/text.h"
#include "server/schema/file_bytes.h"

namespace phrenic::fit {
namespace {

using meshio::TextReader;

constexpr std::size_t kMostLandmarkBytes = 64 << 20;  // some hundred thousand pairs

// Where a CSV has the coordinates: exhale x, y, z, inhale x, y, z, and the phase; -1: not there.
using CsvColumns = std::array<int, 7>;

int CoordinateOf(std::string_view column) {
  constexpr std::array<std::string_view, 6> kNames = {"exhale_x", "exhale_y", "exhale_z",
                                                      "inhale_x", "inhale_y", "inhale_z"};
  for (int i = 0; i < 6; ++i) {
    if (column == kNames[i] || (i < 3 && column == kNames[i].substr(7))) return i;
  }
  return column == "phase" ? 6 : -1;
}

absl::StatusOr<CsvColumns> ReadHeader(const TextReader& reader) {
  CsvColumns columns = {-1, -1, -1, -1, -1, -1, -1};
  int at = 0;
  for (const std::string_view cell : CellsOf(reader.Rest())) {
    const int coordinate = CoordinateOf(absl::AsciiStrToLower(std::string(cell)));
    if (coordinate >= 0 && columns[coordinate] >= 0) return reader.Error("the header names a column twice");
    if (coordinate >= 0) columns[coordinate] = at;
    ++at;
  }
  const bool exhale = columns[0] >= 0 && columns[1] >= 0 && columns[2] >= 0;
  const int inhale =
      static_cast<int>(columns[3] >= 0) + static_cast<int>(columns[4] >= 0) + static_cast<int>(columns[5] >= 0);
  if (exhale && inhale == 0 && columns[6] >= 0)
    return reader.Error("a column phase belongs to pairs: inhale_x is missing");
  if (exhale && (inhale == 0 || inhale == 3)) return columns;
  return reader.Error(
      "the first line must name the columns exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z (points alone: "
      "x,y,z)");
}

// A row: 3 or 6 coordinates in mm, and the phase if there is one.
using CsvNumbers = Eigen::Matrix<double, 7, 1>;

absl::Status ReadRow(const TextReader& reader, const CsvColumns& columns, CsvNumbers& mm) {
  const std::vector<std::string_view> cells = CellsOf(reader.Rest());
  for (int i = 0; i < 7; ++i) {
    if (columns[i] < 0) continue;
    const auto at = static_cast<size_t>(columns[i]);
    if (at >= cells.size()) {
      return reader.Error(absl::StrCat("the header has a column ", at + 1, ", this line has ", cells.size()));
    }
    const std::string_view cell = cells[at];
    if (!meshio::ParseNumber(cell, mm[i])) {
      return reader.Error(absl::StrCat(meshio::Quoted(cell), " in column ", at + 1, " is not a finite number"));
    }
  }
  return absl::OkStatus();
}

// "# space=ras". Returns false for a space that is neither lps nor ras.
bool ReadSpace(std::string_view comment, bool& ras) {
  const std::string text = absl::AsciiStrToLower(std::string(comment));
  const size_t at = text.find("space=");
  if (at == std::string::npos) return true;
  const std::string_view space = Trimmed(std::string_view(text).substr(at + 6));
  ras = space.starts_with("ras");
  return ras || space.starts_with("lps");
}

// The lines of a CSV below its header.
class CsvRows {
 public:
  absl::Status Read(const TextReader& reader, const CsvColumns& columns, bool ras) {
    CsvNumbers mm = CsvNumbers::Zero();
    if (absl::Status status = ReadRow(reader, columns, mm); !status.ok()) return status;
    if (columns[6] >= 0 && !(mm[6] > 0 && mm[6] < 2)) {
      return reader.Error("the phase must be above 0 (end exhale) and below 2 (the next end exhale); 1 is end inhale");
    }
    if (columns[6] >= 0) phase_.push_back(mm[6]);
    absl::Status status = AppendPoint(mm.head<3>(), ras, exhale_);
    if (status.ok() && columns[3] >= 0) status = AppendPoint(mm.segment<3>(3), ras, inhale_);
    return status.ok() ? status : reader.Error(std::string(status.message()));
  }

  Landmarks Take() const {
    Landmarks landmarks = {ColumnsOf(exhale_), ColumnsOf(inhale_)};
    if (landmarks.paired()) landmarks.motion -= landmarks.exhale;
    landmarks.phase = Eigen::Map<const Eigen::VectorXd>(phase_.data(), static_cast<Eigen::Index>(phase_.size()));
    return landmarks;
  }

 private:
  std::vector<Eigen::Vector3d> exhale_, inhale_;
  std::vector<double> phase_;
};

absl::StatusOr<Landmarks> ParseCsv(std::string_view name, std::string_view bytes) {
  TextReader reader(name, bytes);
  bool ras = false, header = false;
  CsvColumns columns = {};
  CsvRows rows;
  while (reader.NextFilledLine()) {
    if (reader.Rest().front() == '#') {
      if (!ReadSpace(reader.Rest(), ras)) return reader.Error("the space must be lps or ras");
    } else if (!header) {
      const auto read = ReadHeader(reader);
      if (!read.ok()) return read.status();
      columns = *read;
      header = true;
    } else if (absl::Status status = rows.Read(reader, columns, ras); !status.ok()) {
      return status;
    }
  }
  return rows.Take();
}

absl::StatusOr<Landmarks> ReadLandmarkFile(const std::string& path) {
  const std::optional<std::string> bytes = ReadBytes(path, kMostLandmarkBytes);
  if (bytes.has_value()) return ParseLandmarks(path, *bytes);
  return absl::NotFoundError(absl::StrCat("cannot read the landmarks ", path,
                                          ": check the path, and that it has at most ", kMostLandmarkBytes >> 20,
                                          " MiB"));
}

}  // namespace

absl::StatusOr<Landmarks> ParseLandmarks(std::string_view name, std::string_view bytes) {
  const std::string lower = absl::AsciiStrToLower(std::string(name));
  absl::StatusOr<Landmarks> landmarks = lower.ends_with(".fcsv")       ? ParseFcsv(name, bytes)
                                        : lower.ends_with(".mrk.json") ? ParseMarkups(name, bytes)
                                                                       : ParseCsv(name, bytes);
  if (landmarks.ok() && landmarks->size() == 0) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": no landmarks: one is needed a line, in mm"));
  }
  return landmarks;
}

absl::StatusOr<Landmarks> ReadLandmarks(const std::vector<std::string>& files) {
  if (files.empty() || files.size() > 2) {
    return absl::InvalidArgumentError(
        "landmarks are one file of pairs, or one file of end exhale and one of end inhale");
  }
  absl::StatusOr<Landmarks> first = ReadLandmarkFile(files[0]);
  if (!first.ok() || files.size() == 1) return first;
  const absl::StatusOr<Landmarks> second = ReadLandmarkFile(files[1]);
  if (!second.ok()) return second.status();
  return PairLandmarks(*first, *second);
}

}  // namespace phrenic::fit
