// What the sections of an MSH file, of whichever version, say of a surface.
#ifndef PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_
#define PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "server/meshio/formats.h"

namespace phrenic::meshio {

// Gmsh's types of elements.
inline constexpr std::int64_t kMshLine = 1, kMshTriangle = 2, kMshQuadrilateral = 3;
inline constexpr std::int64_t kMaxTags = 1000;  // of an element or a block of data: more is no file

// How many nodes an element of the type has; 0 for a type that Gmsh's manual does not have.
int MshNodesOf(std::int64_t type);
// Whether elements of the type are read: lines, triangles and quadrilaterals of first order.
bool MshIsRead(std::int64_t type);

// The line "2.2 0 8" of $MeshFormat.
struct MshVersion {
  double version = 0;
  bool binary = false;
};

class MshSurface {
 public:
  // Statuses have the sentence alone, for the reader to say where.
  absl::Status AddNode(std::int64_t number, double x, double y, double z);
  // An element of MshNodesOf(type) nodes; passed over where MshIsRead(type) says so.
  absl::Status AddElement(std::int64_t type, const std::vector<std::int64_t>& nodes, std::int64_t physical);
  // A line of $PhysicalNames: dimension number "name".
  absl::Status AddPhysicalName(std::string_view line);
  // Whether there is a surface or a network; the sentence says what is missing.
  absl::Status Check() const;
  Mesh ToMesh() const;

 private:
  Collected found_;
  std::int64_t passed_over_ = 0;
  std::vector<int> corners_;
  std::unordered_map<std::int64_t, int> index_of_;  // node number -> vertex
  std::map<std::int64_t, std::string> surface_names_;
  std::vector<std::int64_t> physical_of_triangle_;
};

// Whether the file, which ParseMsh has accepted, is of version 2 in text: a node and an element a line.
bool MshHasRows(std::string_view bytes);

// Reads a file of version 2 in binary, or of 4.1, after its line of $MeshFormat, which ends before byte `at`.
// INVALID_ARGUMENT "name:line: ..." or "name:byte N: ...".
absl::StatusOr<Surface> ParseMshBlocks(std::string_view name, std::string_view bytes, std::size_t at,
                                       const MshVersion& version);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MSH_SURFACE_H_
