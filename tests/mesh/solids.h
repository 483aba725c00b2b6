// Small closed surfaces with known topology, area and volume.
#ifndef PHRENIC_TESTS_MESH_SOLIDS_H_
#define PHRENIC_TESTS_MESH_SOLIDS_H_

#include <cmath>
#include <numbers>

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the unit right tetrahedron with its right-angled corner at `origin`, facing outwards. Volume 1/6 m^3.
inline Mesh Tetrahedron(const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  Mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  mesh.vertices.colwise() += origin;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 1, 0, 2, 1, 2, 3, 1, 3, 3, 2;
  return mesh;
}

// Returns both meshes as separate components of one.
inline Mesh Together(const Mesh& a, const Mesh& b) {
  Mesh mesh;
  mesh.vertices.resize(3, a.vertices.cols() + b.vertices.cols());
  mesh.vertices << a.vertices, b.vertices;
  mesh.triangles.resize(3, a.triangles.cols() + b.triangles.cols());
  mesh.triangles << a.triangles, (b.triangles.array() + static_cast<int>(a.vertices.cols())).matrix();
  return mesh;
}

// Returns a torus about the z axis with major radius `ring` and minor radius `tube` [m]: `around` x `across`
// quadrilaterals, each split in two triangles. Volume 2 pi^2 ring tube^2 in the limit.
inline Mesh Torus(double ring, double tube, int around, int across) {
  Mesh mesh;
  mesh.vertices.resize(3, around * across);
  mesh.triangles.resize(3, 2 * around * across);
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const int here = i * across + j;
      const double r = ring + tube * std::cos(v);
      mesh.vertices.col(here) << r * std::cos(u), r * std::sin(u), tube * std::sin(v);
      const int next = (i + 1) % around * across + j;
      const int up = i * across + (j + 1) % across, corner = (i + 1) % around * across + (j + 1) % across;
      mesh.triangles.col(2 * here) << here, next, corner;
      mesh.triangles.col(2 * here + 1) << here, corner, up;
    }
  }
  return mesh;
}

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MESH_SOLIDS_H_
