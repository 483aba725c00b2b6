// VTK's PolyData in XML (VTK File Formats, "XML File Formats"): text, base64 and appended, plain and zlib.
#include "server/mesh/vtp.h"

#include <algorithm>
#include <cstdint>
#include <pugixml.hpp>

#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/formats.h"
#include "server/meshio/text.h"
#include "server/meshio/vtk_arrays.h"
#include "server/meshio/vtk_cells.h"

namespace phrenic::meshio {
namespace {

constexpr std::string_view kAppended = "<AppendedData";
constexpr std::size_t kSmallest = 16 << 10, kUnpacking = 16;  // bytes; times a file's size

std::string_view Attribute(pugi::xml_node node, const char* name) { return node.attribute(name).value(); }

class XmlParser {
 public:
  XmlParser(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  absl::StatusOr<Surface> Parse() {
    if (absl::Status status = ReadXml(); !status.ok()) return status;
    const pugi::xml_node root = document_.child("VTKFile");
    if (absl::Status status = ReadRoot(root); !status.ok()) return status;
    const pugi::xml_node data = root.child("PolyData");
    ReadFrame(data.child("FieldData"));
    for (const pugi::xml_node piece : data.children("Piece")) {
      if (absl::Status status = ReadPiece(piece); !status.ok()) return status;
    }
    if (const std::string fault = cells_.Fault(); !fault.empty()) return Error(data, fault);
    return Surface{cells_.ToMesh(), frame_};
  }

 private:
  absl::Status Error(pugi::xml_node at, const std::string& message) const {
    const auto place = std::max<std::ptrdiff_t>(0, at.offset_debug());
    return ByteReader(name_, bytes_, static_cast<std::size_t>(place)).Error(message);
  }

  // Appended data may be any bytes, which is not XML: it is cut off first.
  absl::Status ReadXml() {
    const std::size_t cut = bytes_.find(kAppended);
    std::string head(bytes_.substr(0, cut));
    if (cut != std::string_view::npos) {
      const std::size_t end = bytes_.find('>', cut), start = bytes_.find('_', std::min(end, bytes_.size()));
      if (start == std::string_view::npos) {
        return ByteReader(name_, bytes_, cut).Error("AppendedData has no \"_\": the file was cut off");
      }
      encoding_.appended = bytes_.substr(start + 1);
      encoding_.appended_base64 = bytes_.substr(cut, end - cut).find("base64") != std::string_view::npos;
      head += "</VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_buffer(head.data(), head.size());
    if (result) return absl::OkStatus();
    return ByteReader(name_, bytes_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, result.offset)))
        .Error(absl::StrCat("the XML is broken: ", result.description(), "; was the file cut off, or is it no .vtp?"));
  }

  absl::Status ReadRoot(pugi::xml_node root) {
    if (Attribute(root, "type") != "PolyData") {
      return Error(root,
                   absl::StrCat("the file has ", Quoted(Attribute(root, "type")), ", and only PolyData, a surface, ",
                                "is read; extract the surface in ParaView and save it as .vtp"));
    }
    const std::string_view packer = Attribute(root, "compressor");
    if (!packer.empty() && packer != "vtkZLibDataCompressor") {
      return Error(root, absl::StrCat("arrays are compressed by ", Quoted(packer), ", and only zlib is read"));
    }
    encoding_.compressed = !packer.empty();
    encoding_.wide_header = Attribute(root, "header_type") == "UInt64";
    encoding_.order = Attribute(root, "byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
    encoding_.most_bytes = kSmallest + kUnpacking * bytes_.size();
    return absl::OkStatus();
  }

  static VtkArray ArrayOf(pugi::xml_node node) {
    return {Attribute(node, "type"), Attribute(node, "format"), node.child_value(), Attribute(node, "offset")};
  }

  // SPACE is text: characters' numbers, ended by a zero. 3D Slicer's frame where it can be read.
  void ReadFrame(pugi::xml_node field) {
    const pugi::xml_node node = field.find_child_by_attribute("Name", "SPACE");
    VtkArray array = ArrayOf(node);
    if (array.type != "String") return;
    array.type = "UInt8";
    const auto characters = ReadIntegers(array, encoding_);
    if (!characters.ok()) return;
    std::string text;
    for (const std::int64_t character : *characters) {
      if (character > 0 && character < 128) text += static_cast<char>(character);
    }
    frame_ = FrameNamed(text, frame_);
  }

  absl::Status ReadPiece(pugi::xml_node piece) {
    const std::int64_t first = cells_.points();
    const pugi::xml_node points = piece.child("Points").child("DataArray");
    const auto coordinates = ReadDoubles(ArrayOf(points), encoding_);
    if (!coordinates.ok()) return Error(points, absl::StrCat("Points: ", coordinates.status().message()));
    std::int64_t said = 0;
    const bool counted = ParseInteger(Attribute(piece, "NumberOfPoints"), said);
    if (!counted || said < 0 || coordinates->size() % 3 != 0 ||
        coordinates->size() / 3 != static_cast<std::size_t>(said)) {
      return Error(points, absl::StrCat("the piece says ", Quoted(Attribute(piece, "NumberOfPoints")),
                                        " points, and Points has ", coordinates->size(), " numbers"));
    }
    for (const double coordinate : *coordinates) cells_.AddCoordinate(coordinate);
    if (absl::Status status = ReadCells(piece.child("Polys"), VtkCell::kPolygon, first); !status.ok()) return status;
    if (absl::Status status = ReadCells(piece.child("Strips"), VtkCell::kStrip, first); !status.ok()) return status;
    return ReadCells(piece.child("Lines"), VtkCell::kLine, first);
  }

  absl::Status ReadCells(pugi::xml_node node, VtkCell kind, std::int64_t first) {
    if (!node) return absl::OkStatus();
    const auto corners = ReadArray(node, "connectivity"), offsets = ReadArray(node, "offsets");
    if (!corners.ok()) return corners.status();
    if (!offsets.ok()) return offsets.status();
    const std::string fault = cells_.AddAll(kind, *offsets, *corners, false, first);
    return fault.empty() ? absl::OkStatus() : Error(node, absl::StrCat(node.name(), ": ", fault));
  }

  absl::StatusOr<std::vector<std::int64_t>> ReadArray(pugi::xml_node cells, const char* name) const {
    const pugi::xml_node node = cells.find_child_by_attribute("DataArray", "Name", name);
    if (!node) return std::vector<std::int64_t>();
    auto numbers = ReadIntegers(ArrayOf(node), encoding_);
    if (numbers.ok()) return numbers;
    return Error(node, absl::StrCat(cells.name(), " ", name, ": ", numbers.status().message()));
  }

  std::string_view name_, bytes_;
  pugi::xml_document document_;
  VtkEncoding encoding_;
  Frame frame_ = Frame::kUnsaid;
  VtkCells cells_;
};

}  // namespace

absl::StatusOr<Surface> ParseVtp(std::string_view name, std::string_view bytes) {
  return XmlParser(name, bytes).Parse();
}

absl::StatusOr<std::string> WriteVtp(const Mesh& mesh) {
  PolyData data = {.points = mesh.vertices, .triangles = mesh.triangles};
  if (mesh.triangles.cols() == 0) data.lines = mesh.edges;
  return phrenic::WriteVtp(data);
}

}  // namespace phrenic::meshio
