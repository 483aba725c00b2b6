// Solids of tetrahedra: lattices of cells, what lies inside a surface, the surface of a solid.
#ifndef PHRENIC_SERVER_MESH_TETRAHEDRA_H_
#define PHRENIC_SERVER_MESH_TETRAHEDRA_H_

#include <functional>

#include "server/mesh/mesh.h"

namespace phrenic {

struct Lattice {
  Eigen::Vector3d origin;  // [m]
  Eigen::Vector3d cell;    // its width, depth and height [m]
  Eigen::Vector3i cells;   // along each axis
};

// The cells whose centre `keep` takes, five tetrahedra each, with their surface. Cells are split so that neighbours'
// faces match: one tetrahedron over the corners with an even sum of lattice indices, one at each of the odd corners.
Mesh FillCells(const Lattice& lattice, const std::function<bool(const Eigen::Vector3d& centre)>& keep);

// The triangles that belong to one tetrahedron only, facing outwards.
Triangles SurfaceOf(const Tetrahedra& tetrahedra);

// Positive where the vertices are in the order that Tetrahedra asks for [m^3].
double TetrahedronVolume(const Mesh& mesh, Eigen::Index tetrahedron);

// How often the surface's triangles go round the point: 1 inside a closed surface that faces outwards, 0 outside (Van
// Oosterom and Strackee 1983).
double WindingNumber(const Mesh& surface, const Eigen::Vector3d& point);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TETRAHEDRA_H_
