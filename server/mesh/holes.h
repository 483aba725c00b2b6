// Holes of a triangle surface: finds the loops of boundary edges and closes small ones. Threads may call it with
// different meshes.
#ifndef PHRENIC_SERVER_MESH_HOLES_H_
#define PHRENIC_SERVER_MESH_HOLES_H_

#include <string>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

struct Hole {
  std::vector<int> vertices;                         // along the loop, against the winding of the triangles beside it
  double extent = 0;                                 // diagonal of the loop's bounding box [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // mean of its vertices [m]
  bool simple = true;                                // each of its vertices has two boundary edges
  bool rim = false;                                  // extent over half of that of its component: the edge of a sheet
};

// Returns the loops of boundary edges, in the order of their lowest vertices. A rim of a sheet is one of them.
std::vector<Hole> FindHoles(const Mesh& mesh);

// Closes each simple hole of an extent up to `extent` [m] and of at most 400 vertices, unless it is a rim, by the
// triangulation of its loop that has the least area and no edge that the surface has already. (Barequet and Sharir,
// Filling gaps in the boundary of a polyhedron, 1995.) Adds no vertex: triangles span the hole. Returns the number of
// holes closed.
int CloseHoles(double extent, Mesh& mesh);

// Returns words for one hole: number of edges, extent and place [mm]. `millimetres_a_unit` is the unit of the mesh.
std::string Describe(const Hole& hole, double millimetres_a_unit);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_HOLES_H_
