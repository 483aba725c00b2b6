// Reads the motion of a surface: a mesh and its vertices' displacements over time.
#ifndef PHRENIC_SERVER_MESHIO_MOTION_H_
#define PHRENIC_SERVER_MESHIO_MOTION_H_

#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

// `times` and `displacements` have the same size. Plain data.
struct Motion {
  Mesh mesh;                          // at the node coordinates of the file [m]
  std::vector<double> times;          // [s], strictly increasing
  std::vector<Points> displacements;  // per time: displacement of each vertex from `mesh` (3 x n) [m]

  // True if there are two times or more.
  bool moves() const { return times.size() > 1; }
};

// Parses a surface like Parse in meshio.h; in a .msh also the time steps of the $NodeData view "displacement" (see
// server/record/README.md). Without such a view the motion has no times. INVALID_ARGUMENT "name:line: problem and
// remedy", also if a step lacks a row for a node or the view is in another version than MSH 2.2 text. Displacements are
// scaled by `unit` [m per unit of the file] and converted to LPS like the mesh. Times are at most 1e9 s and must
// increase. Thread-safe; all steps are in memory.
absl::StatusOr<Motion> ParseMotion(std::string_view name, std::string_view bytes, double unit);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MOTION_H_
