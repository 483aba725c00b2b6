// The surface file formats: one parser and one writer each. They leave coordinates in the file's unit and frame and
// indices unchecked; meshio.h scales, converts to LPS and validates. All functions are thread-safe.
//
// Parsers return INVALID_ARGUMENT "name:line: ..." or "name:byte N: ...". They allocate in proportion to the data,
// never by a count that a file claims.
#ifndef PHRENIC_SERVER_MESHIO_FORMATS_H_
#define PHRENIC_SERVER_MESHIO_FORMATS_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {

// Wavefront OBJ: "v", "f" (any polygon; v, v/vt, v//vn or v/vt/vn; negative indices) and "l"; other statements are
// ignored. Lines end with "\n" or "\r\n"; written with "\n" and the shortest exact numbers.
absl::StatusOr<Surface> ParseObj(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteObj(const Mesh& mesh);

// Gmsh MSH 2.0-2.2 and 4.1, text and binary: nodes of any numbering, triangles, quadrilaterals and lines. A named
// physical surface becomes a region of the mesh. Written as 2.2 text; a triangle belongs to the first region (by name)
// that holds its three vertices.
absl::StatusOr<Surface> ParseMsh(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteMsh(const Mesh& mesh);

// STL, text and binary. Written as binary float32; INVALID_ARGUMENT if the mesh has no triangles.
absl::StatusOr<Surface> ParseStl(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteStl(const Mesh& mesh);

// PLY 1.0, text and binary of either endianness: vertices, faces (any polygon) and edges; other elements and properties
// are ignored. Written as little-endian binary float64.
absl::StatusOr<Surface> ParsePly(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WritePly(const Mesh& mesh);

// VTK PolyData: legacy .vtk, text and binary, and XML .vtp, uncompressed or zlib. Polygons, triangle strips and lines
// are read; point and cell data are ignored. Written as binary float64.
absl::StatusOr<Surface> ParseVtk(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteVtk(const Mesh& mesh);
absl::StatusOr<Surface> ParseVtp(std::string_view name, std::string_view bytes);
absl::StatusOr<std::string> WriteVtp(const Mesh& mesh);

// `parse` gets the whole file, `write` a mesh that Validate has accepted, in the file's unit. Both are thread-safe.
struct Format {
  std::string_view ending;  // file name extension in lower case, with its dot
  absl::StatusOr<Surface> (*parse)(std::string_view name, std::string_view bytes);
  absl::StatusOr<std::string> (*write)(const Mesh& mesh);  // null if the format is read-only
};

// The catalogue of formats, one row each. It lives as long as the process; Endings() lists it in this order.
const std::vector<Format>& Formats();

// Converts positions or displacements from RAS to LPS, x -> -x and y -> -y, without negative zeros.
void RasToLps(Points& vectors);

// Accumulates a mesh while parsing, in the file's order. Indices are from 0 and may be out of range: meshio.h validates
// the mesh. Not thread-safe.
struct SurfaceBuilder {
  std::vector<double> coordinates;  // x y z per vertex
  std::vector<int> triangles;       // three indices per triangle
  std::vector<int> lines;           // two indices per line

  int vertices() const { return static_cast<int>(coordinates.size() / 3); }
  // Adds a polygon of three corners or more as a fan of triangles at its first corner. Does nothing for fewer corners.
  void AddPolygon(const std::vector<int>& corners);
  // Keeps lines only if there are no triangles; beside triangles, lines are outlines and not a network. Copies; the
  // mesh has no regions.
  Mesh ToMesh() const;
};

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_FORMATS_H_
