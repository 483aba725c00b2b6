// Self-intersections of a triangle surface.
#ifndef PHRENIC_SERVER_MESH_SELF_CROSSINGS_H_
#define PHRENIC_SERVER_MESH_SELF_CROSSINGS_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the number of intersecting pairs of an edge and a triangle without a common vertex, of a surface with its
// vertices at `x` (3 x n) [m]. `cell` [m] is the size of the cells by which pairs are found: about the length of an
// edge is fastest. Thread-safe.
int SelfCrossings(const ConstPoints& x, const Triangles& triangles, double cell);
inline int SelfCrossings(const Mesh& mesh, double cell) { return SelfCrossings(mesh.vertices, mesh.triangles, cell); }

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_SELF_CROSSINGS_H_
