// Motions of a surface: bytes -> a mesh and where its vertices go.
#ifndef PHRENIC_SERVER_MESHIO_MOTION_H_
#define PHRENIC_SERVER_MESHIO_MOTION_H_

#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

struct Motion {
  Mesh mesh;                          // as the file's nodes have it [m]
  std::vector<double> times;          // [s], each later than the one before
  std::vector<Points> displacements;  // one a time: of each vertex from `mesh` [m]

  bool moves() const { return times.size() > 1; }
};

// Parses a surface as Parse in meshio.h does; of a .msh the time steps of the $NodeData view "displacement" as well, as
// server/record/README.md has them. Files without such a view give a motion of no times. Every step has a row for each
// node. Errors are INVALID_ARGUMENT "name:line: what is wrong and what to do".
absl::StatusOr<Motion> ParseMotion(std::string_view name, std::string_view bytes, double unit);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MOTION_H_
