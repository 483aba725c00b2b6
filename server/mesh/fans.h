// The fans of a triangle surface: the sets of triangles at a vertex that are connected by edges there.
#ifndef PHRENIC_SERVER_MESH_FANS_H_
#define PHRENIC_SERVER_MESH_FANS_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Corner 3 t + k is the k-th corner of triangle t. Corners at one vertex whose triangles share an edge there belong to
// one fan. With `part_bodies`, an edge of four triangles or any larger even number connects none, so that bodies that
// touch along an edge have fans of their own. Returns for each corner the representative corner of its fan.
// Thread-safe.
std::vector<int> CornerFans(const Triangles& triangles, bool part_bodies);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_FANS_H_
