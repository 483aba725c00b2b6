// Simple surfaces for tests of distances.
#ifndef PHRENIC_TESTS_COMPARE_SURFACES_H_
#define PHRENIC_TESTS_COMPARE_SURFACES_H_

#include <string>

#include "absl/strings/str_format.h"
#include "server/compare/measured_surface.h"
#include "server/mesh/mesh.h"

namespace phrenic::compare {

inline MeasuredSurface Measured(const Mesh& mesh) { return {mesh.vertices, mesh.triangles}; }

// Returns the mesh translated by `by` [m].
inline Mesh Moved(Mesh mesh, const Eigen::Vector3d& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

// Returns a square with corner at the origin in the plane z = 0, of `cells` x `cells` cells of two triangles; `side`
// [m].
inline Mesh Square(double side, int cells) {
  Mesh mesh;
  mesh.vertices.resize(3, (cells + 1) * (cells + 1));
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) mesh.vertices.col(i * (cells + 1) + j) << side * i / cells, side * j / cells, 0;
  }
  mesh.triangles.resize(3, 2 * cells * cells);
  for (int i = 0, t = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const int corner = i * (cells + 1) + j, next = corner + cells + 1;
      mesh.triangles.col(t++) << corner, next, next + 1;
      mesh.triangles.col(t++) << corner, next + 1, corner + 1;
    }
  }
  return mesh;
}

// Returns the mesh as the text of an OBJ file in millimetres.
inline std::string ObjText(const Mesh& mesh) {
  std::string text;
  for (const auto x : mesh.vertices.colwise()) {
    absl::StrAppendFormat(&text, "v %.9g %.9g %.9g\n", 1e3 * x[0], 1e3 * x[1], 1e3 * x[2]);
  }
  for (const auto t : mesh.triangles.colwise())
    absl::StrAppendFormat(&text, "f %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

}  // namespace phrenic::compare

#endif  // PHRENIC_TESTS_COMPARE_SURFACES_H_
