// The contents of an MSH file of any version: collects nodes, elements and physical groups into a surface.
#ifndef PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_
#define PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/meshio/formats.h"

namespace phrenic::meshio {

// Gmsh's element types.
inline constexpr std::int64_t kMshLine = 1, kMshTriangle = 2, kMshQuadrilateral = 3, kMshPoint = 15;
inline constexpr std::int64_t kMaxTags = 1000;  // of an element or a view; more means a corrupt file

// Returns the number of nodes of an element type; 0 if Gmsh's manual does not list the type.
int MshNodesOf(std::int64_t type);
// True for the element types that are read: points, first-order lines, triangles and quadrilaterals.
bool MshIsSupported(std::int64_t type);

// The line "2.2 0 8" of $MeshFormat.
struct MshVersion {
  double version = 0;
  bool binary = false;
};

// Errors are INVALID_ARGUMENT with the sentence alone; the parser adds the position. Not thread-safe. One parser owns
// it. Nodes come before the elements that name them.
class MshSurface {
 public:
  // `number` is the file's; coordinates are in its unit. An error if the number was used before.
  absl::Status AddNode(std::int64_t number, double x, double y, double z);
  // Adds an element of MshNodesOf(type) nodes; ignores it unless MshIsSupported(type). `physical` is the number of its
  // physical group, 0 for none. A quadrilateral becomes two triangles. An error if a node was not added.
  absl::Status AddElement(std::int64_t type, const std::vector<std::int64_t>& nodes, std::int64_t physical);
  // Adds a line of $PhysicalNames: dimension number "name". Names of curves and volumes are ignored.
  absl::Status AddPhysicalName(std::string_view line);
  // OK if there are triangles or lines; the error says what is missing.
  absl::Status Check() const;
  // Regions are the named physical surfaces, and the points of named physical points. The vertices of a region ascend,
  // each once.
  Mesh ToMesh() const;

 private:
  SurfaceBuilder builder_;                             // vertices in the order of AddNode
  std::int64_t ignored_ = 0;                           // elements of other types
  std::vector<int> corners_;                           // of the present element
  std::unordered_map<std::int64_t, int> index_of_;     // node number -> vertex
  std::map<std::int64_t, std::string> surface_names_;  // physical group -> name
  std::map<std::int64_t, std::string> point_names_;
  std::vector<std::int64_t> physical_of_triangle_;
  std::vector<std::pair<std::int64_t, int>> points_;  // physical group, vertex
};

// True if the file is version 2 text, with one node or element per line. Requires: ParseMsh has accepted the file.
// Reads the version line alone.
bool MshIsVersion2Text(std::string_view bytes);

// Parses a file of version 2 binary or version 4.1 from byte `at`, the start of the line after "2.2 1 8" or "4.1 0 8".
// INVALID_ARGUMENT "name:line: ..." in text, "name:byte N: ..." in binary.
absl::StatusOr<Surface> ParseMshBlocks(std::string_view name, std::string_view bytes, std::size_t at,
                                       const MshVersion& version);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_
