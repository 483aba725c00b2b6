// Tetrahedral solids: meshing a lattice of cells, the boundary of a solid, and the inside test for a surface.
#ifndef PHRENIC_SERVER_MESH_TETRAHEDRA_H_
#define PHRENIC_SERVER_MESH_TETRAHEDRA_H_

#include <functional>

#include "server/mesh/mesh.h"

namespace phrenic {

// An axis-aligned lattice of equal cells.
struct Lattice {
  Eigen::Vector3d origin;  // the lowest corner [m]
  Eigen::Vector3d cell;    // size of a cell along each axis [m]
  Eigen::Vector3i cells;   // number of cells along each axis
};

// Returns the cells for whose centre [m] `keep` is true, each split into five tetrahedra, with their boundary faces as
// triangles. The split is conforming: one tetrahedron joins the corners with an even sum of lattice indices, one cuts
// off each odd corner.
Mesh FillCells(const Lattice& lattice, const std::function<bool(const Eigen::Vector3d& centre)>& keep);

// Returns the boundary faces, which belong to one tetrahedron only, facing outwards.
Triangles SurfaceOf(const Tetrahedra& tetrahedra);

// Returns V = (b - a) . ((c - a) x (d - a)) / 6 [m^3]; positive if the vertices are ordered as Tetrahedra requires.
double TetrahedronVolume(const Mesh& mesh, Eigen::Index tetrahedron);

// Returns the winding number of the surface about the point, the sum of the triangles' signed solid angles / (4 pi)
// (Van Oosterom and Strackee 1983): 1 inside a closed surface that faces outwards, 0 outside. O(triangles).
double WindingNumber(const Mesh& surface, const Eigen::Vector3d& point);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TETRAHEDRA_H_
