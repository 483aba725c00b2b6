// Gmsh's MSH format, version 2 text (Gmsh reference manual, "MSH file format version 2 (Legacy)"). Detects the version
// and passes binary files and version 4.1 on to msh_blocks.cc.
#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/meshio/formats.h"
#include "server/meshio/frame.h"
#include "server/meshio/msh_surface.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr double kVersion4 = 4.1;  // the version that stores blocks of nodes and elements

class MshParser {
 public:
  MshParser(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes), reader_(name, bytes) {}

  absl::StatusOr<Surface> Parse() {
    while (reader_.NextFilledLine()) {
      if (absl::Status status = ReadSection(std::string(reader_.Word())); !status.ok()) return status;
      if (version_.binary || version_.version == kVersion4) {
        return ParseMshBlocks(name_, bytes_, reader_.next_line(), version_);
      }
    }
    if (version_.version == 0) return reader_.Error("the file has no $MeshFormat; is this a Gmsh file?");
    if (absl::Status status = surface_.Check(); !status.ok()) return WithLine(status);
    return Surface{surface_.ToMesh(), frame_};
  }

 private:
  absl::Status WithLine(const absl::Status& status) const {
    return status.ok() ? status : reader_.Error(std::string(status.message()));
  }

  absl::Status ReadSection(const std::string& section) {
    if (section.size() < 2 || section[0] != '$') {
      return reader_.Error(absl::StrCat("a section (\"$Nodes\") is expected, not ", Quoted(section)));
    }
    if (section == "$MeshFormat") return ReadFormat();
    if (version_.version == 0) return reader_.Error("the file does not start with $MeshFormat; is this a Gmsh file?");
    if (section == "$PhysicalNames") return ReadList("$EndPhysicalNames", &MshParser::ReadPhysicalName);
    if (section == "$Comments") return ReadComments();
    if (section == "$Nodes") return ReadList("$EndNodes", &MshParser::ReadNode);
    if (section == "$Elements") return ReadList("$EndElements", &MshParser::ReadElement);
    return SkipTo("$End" + section.substr(1));
  }

  absl::Status ReadFormat() {
    if (version_.version != 0) return reader_.Error("there is a second $MeshFormat");
    MshVersion version;
    std::int64_t binary = 0, size = 0;
    if (!reader_.NextFilledLine() || !reader_.Number(version.version) || !reader_.Integer(binary)) {
      return reader_.Error("$MeshFormat is not followed by \"2.2 0 8\" or \"4.1 0 8\"");
    }
    if ((version.version < 2 || version.version >= 3) && version.version != kVersion4) {
      return reader_.Error(absl::StrCat("MSH version ", version.version, " is not read, only 2.0 to 2.2 and 4.1; ",
                                        "convert it with: gmsh FILE -save -format msh22 -o NEW.msh"));
    }
    version.binary = binary != 0;
    if (version.binary && (!reader_.Integer(size) || size != 8)) {
      return reader_.Error("the file's numbers are not of 8 bytes; convert it with: gmsh FILE -save -o NEW.msh");
    }
    version_ = version;
    return version_.binary || version_.version == kVersion4 ? absl::OkStatus() : SkipTo("$EndMeshFormat");
  }

  absl::Status ReadComments() {
    while (reader_.NextLine()) {
      if (reader_.Rest() == "$EndComments") return absl::OkStatus();
      if (const std::string fault = ReadFrame(reader_.Rest(), frame_); !fault.empty()) return reader_.Error(fault);
    }
    return reader_.Error("the file ends before $EndComments");
  }

  absl::Status SkipTo(const std::string& end) {
    while (reader_.NextLine()) {
      if (reader_.Rest() == end) return absl::OkStatus();
    }
    return reader_.Error(absl::StrCat("the file ends before ", end));
  }

  // Reads the rows of a section. The claimed count is only compared with the actual one, never allocated.
  absl::Status ReadList(const char* end, absl::Status (MshParser::*read_row)()) {
    std::int64_t claimed = 0;
    if (!reader_.NextFilledLine() || !reader_.Integer(claimed)) return reader_.Error("the section's count is missing");
    std::int64_t rows = 0;
    while (reader_.NextFilledLine()) {
      if (reader_.Rest() == end) {
        if (rows == claimed) return absl::OkStatus();
        return reader_.Error(absl::StrCat("the section says ", claimed, " rows but has ", rows));
      }
      if (absl::Status status = (this->*read_row)(); !status.ok()) return status;
      ++rows;
    }
    return reader_.Error(absl::StrCat("the file ends before ", end, ", after ", rows, " of ", claimed, " rows"));
  }

  absl::Status ReadPhysicalName() { return WithLine(surface_.AddPhysicalName(reader_.Rest())); }

  absl::Status ReadNode() {
    std::int64_t number = 0;
    double x = 0, y = 0, z = 0;
    if (!reader_.Integer(number) || !reader_.Number(x) || !reader_.Number(y) || !reader_.Number(z)) {
      return reader_.Error("a node is written: number x y z, all of them finite");
    }
    return WithLine(surface_.AddNode(number, x, y, z));
  }

  absl::Status ReadElement() {
    std::int64_t number = 0, type = 0, tags = 0;
    if (!reader_.Integer(number) || !reader_.Integer(type) || !reader_.Integer(tags) || tags < 0 || tags > kMaxTags) {
      return reader_.Error("an element is written: number type count-of-tags tags... nodes...");
    }
    std::int64_t physical = 0;
    for (std::int64_t tag = 0, value = 0; tag < tags; ++tag) {
      if (!reader_.Integer(value)) return reader_.Error("a tag of the element is missing or not a whole number");
      if (tag == 0) physical = value;
    }
    nodes_.resize(MshIsSupported(type) ? static_cast<std::size_t>(MshNodesOf(type)) : 0);
    for (std::int64_t& node : nodes_) {
      if (!reader_.Integer(node)) {
        return reader_.Error(absl::StrCat("the element needs ", nodes_.size(), " node numbers"));
      }
    }
    return WithLine(surface_.AddElement(type, nodes_, physical));
  }

  std::string_view name_, bytes_;
  TextReader reader_;
  MshVersion version_;  // 0 until $MeshFormat is read
  MshSurface surface_;
  Frame frame_ = Frame::kUnspecified;
  std::vector<std::int64_t> nodes_;
};

// Returns the physical group of each triangle: the number, from 1, of the first region by name that holds its three
// vertices; 0 for none.
std::vector<int> RegionOfTriangles(const Mesh& mesh) {
  std::vector<int> region_of(static_cast<std::size_t>(mesh.triangles.cols()), 0);
  int number = 0;
  for (const auto& [name, region] : mesh.regions) {
    ++number;
    std::vector<bool> inside(static_cast<std::size_t>(mesh.vertices.cols()), false);
    for (const int vertex : region) inside[static_cast<std::size_t>(vertex)] = true;
    for (std::size_t t = 0; t < region_of.size(); ++t) {
      const auto corners = mesh.triangles.col(static_cast<Eigen::Index>(t));
      const bool whole = inside[corners[0]] && inside[corners[1]] && inside[corners[2]];
      if (whole && region_of[t] == 0) region_of[t] = number;
    }
  }
  return region_of;
}

// The points of a region that its triangles alone would not bring back: region number, vertex.
using RegionPoints = std::vector<std::pair<int, int>>;

RegionPoints PointsOfRegions(const Mesh& mesh, const std::vector<int>& region_of) {
  RegionPoints points;
  int number = 0;
  for (const auto& [name, region] : mesh.regions) {
    ++number;
    std::vector<bool> covered(static_cast<std::size_t>(mesh.vertices.cols()), false);
    for (std::size_t t = 0; t < region_of.size(); ++t) {
      if (region_of[t] != number) continue;
      for (const int corner : mesh.triangles.col(static_cast<Eigen::Index>(t))) covered[corner] = true;
    }
    for (const int vertex : region) {
      if (!covered[static_cast<std::size_t>(vertex)]) points.emplace_back(number, vertex);
    }
  }
  return points;
}

// A region is a physical surface, and a physical point as well if it has points of its own.
void AppendPhysicalNames(std::string& text, const Mesh& mesh, const RegionPoints& points) {
  if (mesh.regions.empty()) return;
  std::set<int> with_points;
  for (const auto& [number, vertex] : points) with_points.insert(number);
  absl::StrAppend(&text, "$PhysicalNames\n", mesh.regions.size() + with_points.size(), "\n");
  int number = 0;
  for (const auto& [name, region] : mesh.regions) {
    std::string quotable = name;
    const auto breaks = [](char c) { return c == '"' || static_cast<unsigned char>(c) < ' '; };
    std::replace_if(quotable.begin(), quotable.end(), breaks, '_');
    absl::StrAppend(&text, "2 ", ++number, " \"", quotable, "\"\n");
    if (with_points.contains(number)) absl::StrAppend(&text, "0 ", number, " \"", quotable, "\"\n");
  }
  text += "$EndPhysicalNames\n";
}

void AppendNodes(std::string& text, const Mesh& mesh) {
  absl::StrAppend(&text, "$Nodes\n", mesh.vertices.cols(), "\n");
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    absl::StrAppend(&text, i + 1);
    for (const double coordinate : mesh.vertices.col(i)) AppendNumber(text, coordinate);
    text += "\n";
  }
  text += "$EndNodes\n";
}

void AppendElements(std::string& text, const Mesh& mesh, const std::vector<int>& region_of,
                    const RegionPoints& points) {
  const bool network = mesh.triangles.cols() == 0;
  const Eigen::Index shapes = network ? mesh.edges.cols() : mesh.triangles.cols();
  absl::StrAppend(&text, "$Elements\n", shapes + static_cast<Eigen::Index>(points.size()), "\n");
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const int region = region_of[static_cast<std::size_t>(t)];
    absl::StrAppend(&text, t + 1, " ", kMshTriangle, " 2 ", region, " ", region + 1);
    for (const int corner : mesh.triangles.col(t)) absl::StrAppend(&text, " ", corner + 1);
    text += "\n";
  }
  for (Eigen::Index e = 0; network && e < mesh.edges.cols(); ++e) {
    absl::StrAppend(&text, e + 1, " ", kMshLine, " 2 0 1 ", mesh.edges(0, e) + 1, " ", mesh.edges(1, e) + 1, "\n");
  }
  Eigen::Index number = shapes;
  for (const auto& [region, vertex] : points) {
    absl::StrAppend(&text, ++number, " ", kMshPoint, " 2 ", region, " ", region + 1, " ", vertex + 1, "\n");
  }
  text += "$EndElements\n";
}

}  // namespace

bool MshIsVersion2Text(std::string_view bytes) {
  TextReader reader("", bytes);
  MshVersion version;
  std::int64_t binary = 0;
  return reader.NextFilledLine() && reader.NextFilledLine() && reader.Number(version.version) &&
         reader.Integer(binary) && binary == 0 && version.version < 3;
}

absl::StatusOr<Surface> ParseMsh(std::string_view name, std::string_view bytes) {
  return MshParser(name, bytes).Parse();
}

absl::StatusOr<std::string> WriteMsh(const Mesh& mesh) {
  const std::vector<int> region_of = RegionOfTriangles(mesh);
  const RegionPoints points = PointsOfRegions(mesh, region_of);
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  AppendPhysicalNames(text, mesh, points);
  AppendNodes(text, mesh);
  AppendElements(text, mesh, region_of, points);
  return text;
}

}  // namespace phrenic::meshio
