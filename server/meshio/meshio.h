// Surface files: bytes <-> Mesh.
#ifndef PHRENIC_SERVER_MESHIO_MESHIO_H_
#define PHRENIC_SERVER_MESHIO_MESHIO_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

// The axes that a file says its coordinates run along, as 3D Slicer writes them: "SPACE=LPS" or "SPACE=RAS" in the
// header of an STL, in a comment of an OBJ or a PLY, in the field "SPACE" of a VTK file.
enum class Frame { kUnsaid, kLps, kRas };

struct Surface {
  Mesh mesh;                     // in LPS, whatever the file's own frame
  Frame frame = Frame::kUnsaid;  // the file's own; LPS is assumed where it says none
};

// Parses the bytes of a surface file in the format that `name`'s ending tells, one of Endings(); coordinates are
// multiplied by `unit` [m per unit of the file] and turned from RAS to LPS where the file says that it is in RAS.
// Quadrilaterals and larger polygons are fanned into triangles; vertices keep the file's order (of STL, which has none:
// that of their first triangle, those at exactly one place made one). Errors are INVALID_ARGUMENT "name:line: what is
// wrong and what to do", "name:byte N: ..." in binary parts.
absl::StatusOr<Mesh> Parse(std::string_view name, std::string_view bytes, double unit);
absl::StatusOr<Surface> ParseSurface(std::string_view name, std::string_view bytes, double unit);

// Reads the file and parses it; NOT_FOUND names the path.
absl::StatusOr<Mesh> ReadFile(const std::string& path, double unit);
absl::StatusOr<Surface> ReadSurface(const std::string& path, double unit);

// The bytes of a file in the format that `name`'s ending tells, one of WrittenEndings(): coordinates are divided by
// `unit` [m per unit of the file], in LPS, and where the format has a place for it the file says so. INVALID_ARGUMENT
// "name: ..." where the format cannot hold the mesh. What each format keeps stands in the README.
absl::StatusOr<std::string> Write(std::string_view name, const Mesh& mesh, double unit);

// The endings of the names of files that are read, and written, for people: ".obj, .msh".
std::string Endings();
std::string WrittenEndings();

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MESHIO_H_
