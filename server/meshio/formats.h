// One parser and one writer a format. Coordinates stay in the file's unit and frame; meshio.h scales, turns and
// validates.
#ifndef PHRENIC_SERVER_MESHIO_FORMATS_H_
#define PHRENIC_SERVER_MESHIO_FORMATS_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {

// Wavefront OBJ: "v", "f" (any polygon, v, v/vt, v//vn or v/vt/vn, negative indices) and "l"; the rest is passed over.
absl::StatusOr<Surface> ParseObj(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteObj(const Mesh& mesh);

// Gmsh 2.0-2.2 and 4.1, text and binary: nodes of any numbering, triangles, quadrilaterals and lines. A named physical
// surface becomes a region of the mesh. Written as 2.2 in text; a triangle is of the first region (by name) that has
// its three vertices.
absl::StatusOr<Surface> ParseMsh(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteMsh(const Mesh& mesh);

// STL, text and binary. Written in binary, in float32. Where it is written, the mesh has triangles.
absl::StatusOr<Surface> ParseStl(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteStl(const Mesh& mesh);

// PLY 1.0, text and binary of either byte order: vertices, faces (any polygon) and edges; other elements and properties
// are passed over. Written in binary, little end first, in float64.
absl::StatusOr<Surface> ParsePly(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WritePly(const Mesh& mesh);

// VTK's PolyData: legacy .vtk, text and binary, and .vtp in XML, plain and compressed by zlib. Polygons, strips and
// lines are read; numbers on points and cells are passed over. Written in float64, binary.
absl::StatusOr<Surface> ParseVtk(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteVtk(const Mesh& mesh);
absl::StatusOr<Surface> ParseVtp(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteVtp(const Mesh& mesh);

struct Format {
  std::string_view ending;  // of the file's name, in small letters, with its dot
  absl::StatusOr<Surface> (*parse)(std::string_view name, std::string_view bytes);
  absl::StatusOr<std::string> (*write)(const Mesh& mesh);  // null where the format is only read
};

// The catalogue: one row a format.
const std::vector<Format>& Formats();

// What the parsers collect; vertices and cells in the file's order.
struct Collected {
  std::vector<double> coordinates;  // x y z a vertex
  std::vector<int> triangles;       // three indices a triangle
  std::vector<int> lines;           // two indices a line

  int vertices() const { return static_cast<int>(coordinates.size() / 3); }
  void AddPolygon(const std::vector<int>& corners);  // three or more, fanned from the first
  // Lines are kept only where there are no triangles: beside triangles they are outlines, not a network of their own.
  Mesh ToMesh() const;
};

// The frame that a comment or header says, as 3D Slicer writes it; `otherwise` where it says none.
Frame FrameIn(std::string_view text, Frame otherwise);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_FORMATS_H_
