// Surface files: bytes <-> Mesh.
#ifndef PHRENIC_SERVER_MESHIO_MESHIO_H_
#define PHRENIC_SERVER_MESHIO_MESHIO_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

// Parses the bytes of a surface file in the format that `name`'s ending tells (.obj, .msh); coordinates are multiplied
// by `unit` [m per unit of the file]. Quadrilaterals and larger polygons are fanned into triangles; vertices keep the
// file's order. Errors are INVALID_ARGUMENT "name:line: what is wrong and what to do".
absl::StatusOr<Mesh> Parse(std::string_view name, std::string_view bytes, double unit);

// Reads the file and parses it; NOT_FOUND names the path.
absl::StatusOr<Mesh> ReadFile(const std::string& path, double unit);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MESHIO_H_
