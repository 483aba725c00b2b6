// One parser a format. Coordinates stay in the file's unit; Parse in meshio.h scales and validates.
#ifndef PHRENIC_SERVER_MESHIO_FORMATS_H_
#define PHRENIC_SERVER_MESHIO_FORMATS_H_

#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

// Wavefront OBJ: "v", "f" (any polygon, v, v/vt, v//vn or v/vt/vn, negative indices) and "l"; the rest is passed over.
absl::StatusOr<Mesh> ParseObj(std::string_view name, std::string_view bytes);

// Gmsh 2.0-2.2 in text: nodes of any numbering, triangles, quadrilaterals and lines. A named physical surface becomes
// a region of the mesh.
absl::StatusOr<Mesh> ParseMsh(std::string_view name, std::string_view bytes);

struct Format {
  std::string_view ending;  // of the file's name, in small letters, with its dot
  absl::StatusOr<Mesh> (*parse)(std::string_view name, std::string_view bytes);
};

// The catalogue: one row a format.
const std::vector<Format>& Formats();

// What the parsers collect; vertices and cells in the file's order.
struct Collected {
  std::vector<double> coordinates;  // x y z a vertex
  std::vector<int> triangles;       // three indices a triangle
  std::vector<int> lines;           // two indices a line

  int vertices() const { return static_cast<int>(coordinates.size() / 3); }
  // Lines are kept only where there are no triangles: beside triangles they are outlines, not a network of their own.
  Mesh ToMesh() const;
};

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_FORMATS_H_
