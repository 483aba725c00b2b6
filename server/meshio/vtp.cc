// Reader of VTK XML PolyData (VTK File Formats, "XML File Formats"): text, base64 and appended data, uncompressed or
// zlib. The writer is vtk/polydata.h.
#include <algorithm>
#include <cstdint>
#include <pugixml.hpp>

#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/formats.h"
#include "server/meshio/frame.h"
#include "server/meshio/text.h"
#include "server/meshio/vtk_arrays.h"
#include "server/meshio/vtk_cells.h"
#include "server/vtk/polydata.h"

namespace phrenic::meshio {
namespace {

constexpr std::string_view kAppended = "<AppendedData";
// An array may unpack to 16 KiB plus 16 times the size of the file.
constexpr std::size_t kMinUnpacked = 16 << 10, kUnpackedRatio = 16;

std::string_view Attribute(pugi::xml_node node, const char* name) { return node.attribute(name).value(); }

class XmlParser {
 public:
  XmlParser(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  absl::StatusOr<Surface> Parse() {
    if (absl::Status status = ReadXml(); !status.ok()) return status;
    const pugi::xml_node root = document_.child("VTKFile");
    if (absl::Status status = ReadRoot(root); !status.ok()) return status;
    const pugi::xml_node data = root.child("PolyData");
    for (const pugi::xml_node field : data.children("FieldData")) {
      if (absl::Status status = ReadFields(field); !status.ok()) return status;
    }
    for (const pugi::xml_node piece : data.children("Piece")) {
      if (absl::Status status = ReadPiece(piece); !status.ok()) return status;
    }
    if (const std::string fault = cells_.Fault(); !fault.empty()) return Error(data, fault);
    return Surface{cells_.ToMesh(), frame_};
  }

 private:
  absl::Status Error(pugi::xml_node at, const std::string& message) const {
    const auto offset = std::max<std::ptrdiff_t>(0, at.offset_debug());
    return ByteReader(name_, bytes_, static_cast<std::size_t>(offset)).Error(message);
  }

  // Parses the XML after removing the appended data, whose arbitrary bytes are not XML.
  absl::Status ReadXml() {
    const std::size_t cut = bytes_.find(kAppended);
    std::string head(bytes_.substr(0, cut));
    if (cut != std::string_view::npos) {
      const std::size_t end = bytes_.find('>', cut), start = bytes_.find('_', std::min(end, bytes_.size()));
      if (start == std::string_view::npos) {
        return ByteReader(name_, bytes_, cut).Error("AppendedData has no \"_\": the file is truncated");
      }
      encoding_.appended = bytes_.substr(start + 1);
      encoding_.appended_base64 = bytes_.substr(cut, end - cut).find("base64") != std::string_view::npos;
      head += "</VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_buffer(head.data(), head.size());
    if (result) return absl::OkStatus();
    return ByteReader(name_, bytes_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, result.offset)))
        .Error(absl::StrCat("invalid XML: ", result.description(), "; the file is truncated or not a .vtp file"));
  }

  absl::Status ReadRoot(pugi::xml_node root) {
    if (Attribute(root, "type") != "PolyData") {
      return Error(root,
                   absl::StrCat("the data set is ", Quoted(Attribute(root, "type")), ", but only PolyData, a surface, ",
                                "is supported; extract the surface in ParaView and save it as .vtp"));
    }
    const std::string_view compressor = Attribute(root, "compressor");
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
      return Error(root, absl::StrCat("the compressor ", Quoted(compressor), " is not supported, only zlib"));
    }
    encoding_.compressed = !compressor.empty();
    encoding_.wide_header = Attribute(root, "header_type") == "UInt64";
    encoding_.order = Attribute(root, "byte_order") == "BigEndian" ? std::endian::big : std::endian::little;
    encoding_.max_unpacked = kMinUnpacked + kUnpackedRatio * bytes_.size();
    return absl::OkStatus();
  }

  static VtkArray ArrayOf(pugi::xml_node node) {
    return {Attribute(node, "type"), Attribute(node, "format"), node.child_value(), Attribute(node, "offset")};
  }

  // Reads 3D Slicer's field SPACE.
  absl::Status ReadFields(pugi::xml_node fields) {
    for (const pugi::xml_node field : fields.children()) {
      if (!IsFrameField(Attribute(field, "Name"))) continue;
      const std::string fault = ReadFrameArray(ArrayOf(field));
      if (!fault.empty()) return Error(field, fault);
    }
    return absl::OkStatus();
  }

  // Reads a String array of character codes ended by 0. Returns the fault, or an empty text.
  std::string ReadFrameArray(VtkArray array) {
    const bool text_array = array.type == "String";
    array.type = "UInt8";
    const auto characters = ReadIntegers(array, encoding_);
    if (!text_array || !characters.ok()) return "the field SPACE is not a string; state LPS or RAS there, or remove it";
    std::string text;
    for (const std::int64_t character : *characters) {
      if (character != 0) text += character > 0 && character < 128 ? static_cast<char>(character) : '?';
    }
    return ReadFrameField(text, frame_);
  }

  absl::Status ReadPiece(pugi::xml_node piece) {
    const std::int64_t first = cells_.points();
    const pugi::xml_node points = piece.child("Points").child("DataArray");
    const auto coordinates = ReadDoubles(ArrayOf(points), encoding_);
    if (!coordinates.ok()) return Error(points, absl::StrCat("Points: ", coordinates.status().message()));
    std::int64_t declared = 0;
    const bool counted = ParseInteger(Attribute(piece, "NumberOfPoints"), declared);
    if (!counted || declared < 0 || coordinates->size() % 3 != 0 ||
        coordinates->size() / 3 != static_cast<std::size_t>(declared)) {
      return Error(points, absl::StrCat("the piece declares ", Quoted(Attribute(piece, "NumberOfPoints")),
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
  Frame frame_ = Frame::kUnspecified;
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
