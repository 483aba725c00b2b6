// PLY 1.0, the polygon file format (G. Turk, "The PLY Polygon File Format", 1994).
#include <cmath>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/formats.h"
#include "server/meshio/ply_header.h"
#include "server/meshio/ply_values.h"

namespace phrenic::meshio {
namespace {

class PlyParser {
 public:
  PlyParser(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes), header_reader_(name, bytes) {}

  absl::StatusOr<Surface> Parse() {
    const absl::StatusOr<PlyHeader> header = ReadPlyHeader(header_reader_);
    if (!header.ok()) return header.status();
    for (const PlyElement& element : header->elements) {
      if (element.name == "vertex") vertices_ = element.count;
    }
    values_ = MakePlyValues(header->encoding, name_, bytes_, header_reader_);
    for (const PlyElement& element : header->elements) {
      if (absl::Status status = ReadElement(element); !status.ok()) return status;
    }
    if (!values_->AtEnd()) return values_->Error("the file has data after the last row that its header declares");
    if (builder_.triangles.empty() && builder_.lines.empty()) {
      return values_->Error(absl::StrCat("the file has ", builder_.vertices(), " vertices but neither faces nor edges",
                                         strips_ ? "; triangle strips are not read: save it with faces" : ""));
    }
    return Surface{builder_.ToMesh(), header->frame};
  }

 private:
  absl::Status ReadElement(const PlyElement& element) {
    strips_ = strips_ || element.name == "tristrips";
    for (std::int64_t row = 0; row < element.count; ++row) {
      if (!values_->NextRow()) {
        return values_->Error(absl::StrCat("the file ends after ", row, " of ", element.count, " rows of element ",
                                           Quoted(element.name), ": it is truncated; download or export it again"));
      }
      if (absl::Status status = ReadRow(element); !status.ok()) return status;
      if (absl::Status status = AddRow(element); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // Reads a row: scalar properties into row_, the list of a face's vertices into corners_.
  absl::Status ReadRow(const PlyElement& element) {
    row_.assign(element.properties.size(), 0);
    corners_.clear();
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!values_->Take(property.list ? property.count_type : property.type, row_[i])) return RowTooShort(element);
      if (!property.list) continue;
      if (!(row_[i] >= 0) || row_[i] != std::floor(row_[i]))
        return values_->Error("a list's length is not a whole number");
      const bool face = property.name == "vertex_indices" || property.name == "vertex_index";
      if (absl::Status status = ReadList(element, property, row_[i], face); !status.ok()) return status;
    }
    if (values_->AtEndOfRow()) return absl::OkStatus();
    return values_->Error(
        absl::StrCat("the row has more numbers than element ", Quoted(element.name), " has properties"));
  }

  absl::Status ReadList(const PlyElement& element, const PlyProperty& property, double length, bool face) {
    for (double i = 0; i < length; ++i) {
      double number = 0;
      if (!values_->Take(property.type, number)) return RowTooShort(element);
      if (!face || element.name != "face") continue;
      if (absl::Status status = AddCorner(number); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status RowTooShort(const PlyElement& element) const {
    return values_->Error(absl::StrCat("the row of element ", Quoted(element.name),
                                       " ends early: the file is truncated, or its header does not match"));
  }

  absl::Status AddCorner(double index) {
    if (!(index >= 0) || index >= static_cast<double>(vertices_) || index != std::floor(index)) {
      return values_->Error(absl::StrCat("index ", index, " names no vertex; there are ", vertices_, ", from 0"));
    }
    corners_.push_back(static_cast<int>(index));
    return absl::OkStatus();
  }

  absl::Status AddRow(const PlyElement& element) {
    if (element.name == "vertex") return AddVertex(element);
    if (element.name == "face") return AddFace(element);
    if (element.name == "edge") return AddEdge(element);
    return absl::OkStatus();
  }

  absl::Status AddVertex(const PlyElement& element) {
    for (const char* axis : {"x", "y", "z"}) {
      const double coordinate = row_[static_cast<std::size_t>(element.Find(axis))];
      if (!std::isfinite(coordinate)) {
        return values_->Error(absl::StrCat("the vertex's ", axis, " is not a finite number"));
      }
      builder_.coordinates.push_back(coordinate);
    }
    return absl::OkStatus();
  }

  absl::Status AddFace(const PlyElement& element) {
    if (element.Find("vertex_indices") < 0 && element.Find("vertex_index") < 0) {
      return values_->Error("the faces have no list \"vertex_indices\"");
    }
    if (corners_.size() < 3) {
      return values_->Error(absl::StrCat("a face needs at least 3 vertices, this one has ", corners_.size()));
    }
    builder_.AddPolygon(corners_);
    return absl::OkStatus();
  }

  absl::Status AddEdge(const PlyElement& element) {
    for (const char* end : {"vertex1", "vertex2"}) {
      const int property = element.Find(end);
      if (property < 0) return values_->Error(absl::StrCat("the edges have no property \"", end, "\""));
      if (absl::Status status = AddCorner(row_[static_cast<std::size_t>(property)]); !status.ok()) return status;
    }
    builder_.lines.insert(builder_.lines.end(), corners_.begin(), corners_.end());
    return absl::OkStatus();
  }

  std::string_view name_, bytes_;
  TextReader header_reader_;
  std::unique_ptr<PlyValues> values_;
  std::int64_t vertices_ = 0;  // as the header declares
  SurfaceBuilder builder_;
  std::vector<double> row_;
  std::vector<int> corners_;
  bool strips_ = false;
};

}  // namespace

absl::StatusOr<Surface> ParsePly(std::string_view name, std::string_view bytes) {
  return PlyParser(name, bytes).Parse();
}

absl::StatusOr<std::string> WritePly(const Mesh& mesh) {
  const bool faces = mesh.triangles.cols() > 0;
  std::string bytes =
      absl::StrCat("ply\nformat binary_little_endian 1.0\ncomment Phrenic. SPACE=LPS\nelement vertex ",
                   mesh.vertices.cols(), "\nproperty double x\nproperty double y\nproperty double z\nelement ",
                   faces ? absl::StrCat("face ", mesh.triangles.cols(), "\nproperty list uchar int vertex_indices")
                         : absl::StrCat("edge ", mesh.edges.cols(), "\nproperty int vertex1\nproperty int vertex2"),
                   "\nend_header\n");
  for (const double coordinate : mesh.vertices.reshaped()) AppendBytes(bytes, coordinate);
  for (const auto triangle : mesh.triangles.colwise()) {
    bytes += '\3';
    for (const int corner : triangle) AppendBytes(bytes, static_cast<std::int32_t>(corner));
  }
  if (faces) return bytes;
  for (const int end : mesh.edges.reshaped()) AppendBytes(bytes, static_cast<std::int32_t>(end));
  return bytes;
}

}  // namespace phrenic::meshio
