// Reads and writes surface files: OBJ, MSH, STL, PLY, VTK and VTP. All functions are thread-safe.
#ifndef PHRENIC_SERVER_MESHIO_MESHIO_H_
#define PHRENIC_SERVER_MESHIO_MESHIO_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic::meshio {

// The patient frame that a file declares, by 3D Slicer's convention: "SPACE=LPS" or "SPACE=RAS" in the header of an
// STL, in a comment of an OBJ or a PLY, or in the field "SPACE" of a VTK file. LPS: +x to the patient's left, +y
// posterior, +z superior. RAS: +x right, +y anterior, +z superior.
enum class Frame { kUnspecified, kLps, kRas };

// In metres and LPS from the functions here, in the file's unit and frame from those of formats.h.
struct Surface {
  Mesh mesh;                          // in LPS, whatever the file's frame
  Frame frame = Frame::kUnspecified;  // the file's; read as LPS if unspecified
};

// Parses a surface file in the format of `name`'s extension, one of Endings(). Multiplies coordinates by `unit` [m per
// unit of the file] and converts RAS to LPS if the file declares RAS. Polygons become fans of triangles; vertices keep
// the file's order. STL has no shared vertices: bitwise equal points become one vertex, in the order they first occur.
// Errors: INVALID_ARGUMENT "name:line: problem and remedy", or "name:byte N: ..." in binary data. Also INVALID_ARGUMENT
// for a file above 1 GiB, an unknown extension, and a mesh that Validate refuses. Requires: unit > 0.
absl::StatusOr<Mesh> Parse(std::string_view name, std::string_view bytes, double unit);
absl::StatusOr<Surface> ParseSurface(std::string_view name, std::string_view bytes, double unit);

// Reads and parses a file. Also NOT_FOUND or PERMISSION_DENIED with the path. The whole file is read into memory.
// INVALID_ARGUMENT for a path that is not a regular file.
absl::StatusOr<Mesh> ReadFile(const std::string& path, double unit);
absl::StatusOr<Surface> ReadSurface(const std::string& path, double unit);

// Returns the bytes of a file in the format of `name`'s extension, one of WrittenEndings(). Divides coordinates by
// `unit` [m per unit of the file]; the frame is LPS, and the file declares it if the format can. INVALID_ARGUMENT
// "name: ..." if the mesh is invalid or the format cannot represent it. The README lists what each format keeps. A mesh
// needs triangles or edges. Requires: unit > 0. The inverse of Parse, up to what the format loses.
absl::StatusOr<std::string> Write(std::string_view name, const Mesh& mesh, double unit);

// Return the extensions that can be read, and written, for messages: ".obj, .msh".
std::string Endings();
std::string WrittenEndings();

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MESHIO_H_
