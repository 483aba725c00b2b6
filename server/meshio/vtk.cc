// VTK legacy PolyData, text and binary, versions 1 to 5.1 (VTK File Formats, "Simple Legacy Formats"). Binary data is
// big-endian.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/formats.h"
#include "server/meshio/frame.h"
#include "server/meshio/text.h"
#include "server/meshio/vtk_cells.h"

namespace phrenic::meshio {
namespace {

constexpr std::size_t kMaxLine = 256;  // of the header
// A string in a binary file follows its length. The length's two high bits encode its size; 3 means one byte, with the
// length in the other six bits.
constexpr int kShortText = 3;
constexpr unsigned char kLengthBits = 0x3f;

struct Type {
  std::string_view name;
  int bytes;
};
constexpr std::array<Type, 14> kVtkTypes = {{{"char", 1},
                                             {"unsigned_char", 1},
                                             {"short", 2},
                                             {"unsigned_short", 2},
                                             {"int", 4},
                                             {"unsigned_int", 4},
                                             {"vtkidtype", 4},
                                             {"vtktypeint32", 4},
                                             {"long", 8},
                                             {"unsigned_long", 8},
                                             {"vtktypeint64", 8},
                                             {"vtktypeuint64", 8},
                                             {"float", 4},
                                             {"double", 8}}};

// Returns the size of a type in a binary file [bytes]; 0 for an unknown type.
int BytesOf(std::string_view type) {
  const std::string small = absl::AsciiStrToLower(std::string(type));
  for (const Type& known : kVtkTypes) {
    if (known.name == small) return known.bytes;
  }
  return 0;
}

class LegacyParser {
 public:
  LegacyParser(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  absl::StatusOr<Surface> Parse() {
    if (absl::Status status = ReadHeader(); !status.ok()) return status;
    while (!done_) {
      const std::string keyword = absl::AsciiStrToUpper(std::string(Word()));
      if (keyword.empty()) break;
      if (absl::Status status = ReadSection(keyword); !status.ok()) return status;
    }
    if (const std::string fault = cells_.Fault(); !fault.empty()) return Error(fault);
    return Surface{cells_.ToMesh(), frame_};
  }

 private:
  absl::Status Error(const std::string& message) const {
    if (binary_) return ByteReader(name_, bytes_, at_).Error(message);
    const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    return TextReader(name_, bytes_).ErrorAt(static_cast<int>(line), message);
  }

  std::string_view Line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  // Returns the next whitespace-separated word, also from later lines.
  std::string_view Word() {
    at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size());
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    const std::string_view word = bytes_.substr(at_, end - at_);
    at_ = end;
    return word;
  }
  bool Count(std::int64_t& count) { return ParseInteger(Word(), count) && count >= 0; }

  absl::Status ReadHeader() {
    const std::string_view version = Line().substr(0, kMaxLine);
    if (version.substr(0, 22) != "# vtk DataFile Version") {
      return Error("the file does not begin with \"# vtk DataFile Version\"; is this a .vtk file?");
    }
    if (const std::string fault = ReadFrame(Line(), frame_); !fault.empty()) return Error(fault);
    const std::string kind = absl::AsciiStrToUpper(std::string(Word()));
    if (kind != "ASCII" && kind != "BINARY") return Error("the third line is neither ASCII nor BINARY");
    if (absl::AsciiStrToUpper(std::string(Word())) != "DATASET") return Error("the fourth line has no DATASET");
    const std::string data = absl::AsciiStrToUpper(std::string(Word()));
    if (data != "POLYDATA") {
      return Error(absl::StrCat("the data set is ", Quoted(data),
                                ", but only POLYDATA, a surface, is supported; extract the surface in ParaView and "
                                "save it as .vtp"));
    }
    binary_ = kind == "BINARY";
    return absl::OkStatus();
  }

  absl::Status ReadSection(const std::string& keyword) {
    if (keyword == "POINTS") return ReadPoints();
    if (keyword == "VERTICES" || keyword == "LINES" || keyword == "POLYGONS" || keyword == "TRIANGLE_STRIPS") {
      return ReadCells(keyword);
    }
    if (keyword == "FIELD") return ReadField();
    if (keyword == "METADATA") {
      Line();
      while (!Line().empty()) continue;
      return absl::OkStatus();
    }
    // Point and cell data come last and do not affect the geometry.
    done_ = keyword == "POINT_DATA" || keyword == "CELL_DATA";
    if (done_) return absl::OkStatus();
    return Error(absl::StrCat("there is no section ", Quoted(keyword), " of POLYDATA"));
  }

  // Reads one number: of the given type in binary, a word in text. Returns false if there is none.
  template <typename Number>
  bool Take(std::string_view type, Number& number) {
    if (!binary_) {
      if constexpr (std::is_same_v<Number, double>) {
        return ParseNumber(Word(), number);
      } else {
        return ParseInteger(Word(), number);
      }
    }
    ByteReader reader(name_, bytes_, at_, std::endian::big);
    const bool taken = TakeBinary(absl::AsciiStrToLower(std::string(type)), reader, number);
    at_ = reader.at();
    return taken;
  }

  template <typename Number>
  static bool TakeBinary(const std::string& type, ByteReader& reader, Number& number) {
    const auto as = [&](auto raw) {
      if (!reader.Take(raw)) return false;
      number = static_cast<Number>(raw);
      return true;
    };
    if constexpr (std::is_same_v<Number, double>) {
      if (type == "float") return as(float{}) && std::isfinite(number);
      return type == "double" && as(double{}) && std::isfinite(number);
    } else {
      return BytesOf(type) == 8 ? as(std::int64_t{}) : as(std::int32_t{});
    }
  }

  absl::Status ReadPoints() {
    std::int64_t count = 0;
    if (!Count(count) || count > static_cast<std::int64_t>(bytes_.size())) {
      return Error("POINTS is not followed by a count, or the count exceeds the file's size");
    }
    const std::string_view type = Word();
    if (type != "float" && type != "double")
      return Error(absl::StrCat("points are float or double, not ", Quoted(type)));
    if (binary_) Line();
    for (std::int64_t i = 0; i < 3 * count; ++i) {
      double coordinate = 0;
      if (!Take(type, coordinate)) {
        return Error(absl::StrCat("coordinate ", i % 3, " of point ", i / 3, " of ", count,
                                  " is missing or not a finite number"));
      }
      cells_.AddCoordinate(coordinate);
    }
    return absl::OkStatus();
  }

  absl::Status ReadCells(const std::string& kind) {
    std::int64_t count = 0, size = 0;
    if (!Count(count) || !Count(size)) return Error(absl::StrCat(kind, " is not followed by two numbers"));
    if (binary_) Line();
    const std::size_t start = at_;
    if (absl::AsciiStrToUpper(std::string(Word())) == "OFFSETS") return ReadOffsetCells(kind, count, size);
    at_ = start;
    std::int64_t read = 0;
    for (std::int64_t cell = 0; cell < count; ++cell) {
      std::int64_t corners = 0;
      if (!Take("int", corners) || corners < 1 || corners > size - read) {
        return Error(absl::StrCat("the number of corners of cell ", cell, " of ", kind, " is missing or too large"));
      }
      if (absl::Status status = TakeIndices("int", corners, kind); !status.ok()) return status;
      cells_.Add(KindOf(kind), corners_);
      read += corners + 1;
    }
    return read == size ? absl::OkStatus() : Error(absl::StrCat(kind, " declares ", size, " numbers but has ", read));
  }

  // Reads cells of version 5: the offset of each cell's end, then the concatenated corners.
  absl::Status ReadOffsetCells(const std::string& kind, std::int64_t count, std::int64_t size) {
    const std::string_view type = Word();
    if (BytesOf(type) < 4) return Error(absl::StrCat("offsets of type ", Quoted(type), " are not supported"));
    if (binary_) Line();
    if (absl::Status status = TakeIndices(type, count, kind); !status.ok()) return status;
    const std::vector<std::int64_t> offsets = corners_;
    if (absl::AsciiStrToUpper(std::string(Word())) != "CONNECTIVITY") return Error("CONNECTIVITY is expected");
    const std::string_view corner_type = Word();
    if (BytesOf(corner_type) < 4)
      return Error(absl::StrCat("corners of type ", Quoted(corner_type), " are not supported"));
    if (binary_) Line();
    if (absl::Status status = TakeIndices(corner_type, size, kind); !status.ok()) return status;
    const std::string fault = cells_.AddAll(KindOf(kind), offsets, corners_, true);
    return fault.empty() ? absl::OkStatus() : Error(absl::StrCat(kind, ": ", fault));
  }

  static VtkCell KindOf(const std::string& kind) {
    if (kind == "POLYGONS") return VtkCell::kPolygon;
    if (kind == "LINES") return VtkCell::kLine;
    return kind == "TRIANGLE_STRIPS" ? VtkCell::kStrip : VtkCell::kVertex;
  }

  absl::Status TakeIndices(std::string_view type, std::int64_t count, const std::string& kind) {
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) {
      std::int64_t index = 0;
      if (!Take(type, index)) return Error(absl::StrCat("number ", i, " of ", count, " of ", kind, " is missing"));
      corners_.push_back(index);
    }
    return absl::OkStatus();
  }

  // Reads field data. Keeps only SPACE, the frame, as 3D Slicer writes it.
  absl::Status ReadField() {
    std::int64_t arrays = 0;
    Word();
    if (!Count(arrays)) return Error("FIELD is not followed by a name and a number of arrays");
    for (std::int64_t a = 0; a < arrays; ++a) {
      std::string_view name = Word();
      while (name == "METADATA") {
        Line();
        while (!Line().empty()) continue;
        name = Word();
      }
      std::int64_t components = 0, tuples = 0;
      if (!Count(components) || !Count(tuples)) return Error("an array is written: name components tuples type");
      if (components > 0 && tuples > static_cast<std::int64_t>(bytes_.size()) / components) {
        return Error("the array's size exceeds the file's size");
      }
      if (absl::Status status = SkipArray(name, components * tuples); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status SkipArray(std::string_view name, std::int64_t count) {
    const std::string_view type = Word();
    Line();
    if (type == "string") return ReadTexts(name, count);
    const int size = BytesOf(type);
    if (size == 0) return Error(absl::StrCat("there is no type ", Quoted(type)));
    if (IsFrameField(name)) return Error("the field SPACE is not a string; state LPS or RAS there, or remove it");
    for (std::int64_t i = 0; !binary_ && i < count; ++i) {
      if (Word().empty()) return Error("the file ends within an array");
    }
    if (!binary_) return absl::OkStatus();
    ByteReader reader(name_, bytes_, at_);
    if (!reader.Skip(static_cast<std::size_t>(count * size))) return Error("the file ends within an array");
    at_ = reader.at();
    return absl::OkStatus();
  }

  absl::Status ReadTexts(std::string_view name, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      std::string_view text;
      if (!binary_) {
        text = Line();
      } else {
        if (at_ >= bytes_.size() || static_cast<unsigned char>(bytes_[at_]) >> 6 != kShortText) {
          return Error("a string in an array is missing or longer than 63 characters");
        }
        text = bytes_.substr(at_ + 1, static_cast<unsigned char>(bytes_[at_]) & kLengthBits);
        at_ = std::min(at_ + 1 + text.size(), bytes_.size());
      }
      if (!IsFrameField(name)) continue;
      if (const std::string fault = ReadFrameField(text, frame_); !fault.empty()) return Error(fault);
    }
    return absl::OkStatus();
  }

  std::string_view name_, bytes_;
  std::size_t at_ = 0;
  bool binary_ = false, done_ = false;
  Frame frame_ = Frame::kUnspecified;
  VtkCells cells_;
  std::vector<std::int64_t> corners_;
};

template <typename T>
void AppendBigEndian(std::string& bytes, T number) {
  const std::size_t start = bytes.size();
  AppendBytes(bytes, number);
  std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end());
}

template <typename Cells>
void AppendCells(const char* kind, const Cells& cells, std::string& bytes) {
  if (cells.cols() == 0) return;
  absl::StrAppend(&bytes, kind, " ", cells.cols(), " ", (cells.rows() + 1) * cells.cols(), "\n");
  for (const auto cell : cells.colwise()) {
    AppendBigEndian(bytes, static_cast<std::int32_t>(cells.rows()));
    for (const int corner : cell) AppendBigEndian(bytes, std::int32_t{corner});
  }
  bytes += "\n";
}

}  // namespace

absl::StatusOr<Surface> ParseVtk(std::string_view name, std::string_view bytes) {
  return LegacyParser(name, bytes).Parse();
}

absl::StatusOr<std::string> WriteVtk(const Mesh& mesh) {
  std::string bytes =
      "# vtk DataFile Version 4.2\nPhrenic\nBINARY\nDATASET POLYDATA\nFIELD FieldData 1\nSPACE 1 1 string\n";
  constexpr std::string_view kFrame = "LPS";
  bytes += static_cast<char>((kShortText << 6) | kFrame.size());
  absl::StrAppend(&bytes, std::string(kFrame), "\nPOINTS ", mesh.vertices.cols(), " double\n");
  for (const double coordinate : mesh.vertices.reshaped()) AppendBigEndian(bytes, coordinate);
  bytes += "\n";
  AppendCells("POLYGONS", mesh.triangles, bytes);
  if (mesh.triangles.cols() == 0) AppendCells("LINES", mesh.edges, bytes);
  return bytes;
}

}  // namespace phrenic::meshio
