#include "server/meshio/msh_surface.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

// Nodes by element type (Gmsh reference manual, "MSH file format").
constexpr std::array<int, 32> kNodes = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                        8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};

}  // namespace

int MshNodesOf(std::int64_t type) {
  if (type == 92) return 64;   // third-order hexahedron
  if (type == 93) return 125;  // fourth-order hexahedron
  return type > 0 && type < static_cast<std::int64_t>(kNodes.size()) ? kNodes[static_cast<std::size_t>(type)] : 0;
}

bool MshIsSupported(std::int64_t type) {
  return type == kMshPoint || type == kMshLine || type == kMshTriangle || type == kMshQuadrilateral;
}

absl::Status MshSurface::AddNode(std::int64_t number, double x, double y, double z) {
  if (!index_of_.emplace(number, builder_.vertices()).second) {
    return absl::InvalidArgumentError(absl::StrCat("node ", number, " is there twice"));
  }
  builder_.coordinates.insert(builder_.coordinates.end(), {x, y, z});
  return absl::OkStatus();
}

absl::Status MshSurface::AddElement(std::int64_t type, const std::vector<std::int64_t>& nodes, std::int64_t physical) {
  if (!MshIsSupported(type)) {
    ++ignored_;
    return absl::OkStatus();
  }
  corners_.clear();
  for (const std::int64_t node : nodes) {
    const auto found = index_of_.find(node);
    if (found == index_of_.end()) {
      return absl::InvalidArgumentError(absl::StrCat("the element names node ", node, ", which is not among the ",
                                                     builder_.vertices(), " of $Nodes before it"));
    }
    corners_.push_back(found->second);
  }
  if (type == kMshPoint) {
    points_.emplace_back(physical, corners_[0]);
    return absl::OkStatus();
  }
  if (corners_.size() == 2) builder_.lines.insert(builder_.lines.end(), corners_.begin(), corners_.end());
  builder_.AddPolygon(corners_);
  physical_of_triangle_.resize(builder_.triangles.size() / 3, physical);
  return absl::OkStatus();
}

absl::Status MshSurface::AddPhysicalName(std::string_view line) {
  TextReader reader("", line);
  std::int64_t dimension = 0, number = 0;
  if (!reader.NextLine() || !reader.Integer(dimension) || !reader.Integer(number)) {
    return absl::InvalidArgumentError("a physical name is written: dimension number \"name\"");
  }
  const std::string_view name = reader.Rest();
  if (name.size() < 3 || name.front() != '"' || name.back() != '"') {
    return absl::InvalidArgumentError("the physical name is not in double quotes");
  }
  if (dimension == 2) surface_names_[number] = std::string(name.substr(1, name.size() - 2));
  if (dimension == 0) point_names_[number] = std::string(name.substr(1, name.size() - 2));
  return absl::OkStatus();
}

absl::Status MshSurface::Check() const {
  if (builder_.coordinates.empty()) return absl::InvalidArgumentError("the file has no nodes");
  if (!builder_.triangles.empty() || !builder_.lines.empty()) return absl::OkStatus();
  const auto others = ignored_ + static_cast<std::int64_t>(points_.size());
  return absl::InvalidArgumentError(
      absl::StrCat("the file has no first-order triangles, quadrilaterals or lines", others > 0 ? ", only " : "",
                   others > 0 ? absl::StrCat(others, " elements of other types") : "",
                   "; generate the surface with: gmsh FILE -2 -order 1 -format msh22 -o NEW.msh"));
}

Mesh MshSurface::ToMesh() const {
  Mesh mesh = builder_.ToMesh();
  for (std::size_t triangle = 0; triangle < physical_of_triangle_.size(); ++triangle) {
    const auto name = surface_names_.find(physical_of_triangle_[triangle]);
    if (name == surface_names_.end()) continue;
    std::vector<int>& region = mesh.regions[name->second];
    const auto corners = builder_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
    region.insert(region.end(), corners, corners + 3);
  }
  for (const auto& [physical, vertex] : points_) {
    const auto name = point_names_.find(physical);
    if (name != point_names_.end()) mesh.regions[name->second].push_back(vertex);
  }
  for (auto& [name, region] : mesh.regions) {
    std::sort(region.begin(), region.end());
    region.erase(std::unique(region.begin(), region.end()), region.end());
  }
  return mesh;
}

}  // namespace phrenic::meshio
