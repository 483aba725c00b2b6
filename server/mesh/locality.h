// Vertex orders with locality: vertices joined by edges, or close in space, get close indices, so that a loop over them
// hits the cache. All functions are deterministic.
#ifndef PHRENIC_SERVER_MESH_LOCALITY_H_
#define PHRENIC_SERVER_MESH_LOCALITY_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the vertices in reverse Cuthill-McKee order (Cuthill and McKee 1969, George 1971), each once: breadth first
// from a vertex of least degree, neighbours by ascending degree, reversed. Vertices without edges are left out.
// Requires: every index in `edges` is below `vertices`. O(edges) time and memory, plus sorting.
std::vector<int> CuthillMcKeeOrder(const Edges& edges, int vertices);

// Returns CuthillMcKeeOrder if the ends of an edge are on average more than 8192 indices apart; else empty, because the
// present order already fits a core's cache.
std::vector<int> CuthillMcKeeIfScattered(const Edges& edges, int vertices);

// Returns the indices of all points in the order of a Hilbert curve through their bounding cube (Skilling, AIP Conf
// Proc 2004;707:381) with 1024 cells per side. Points in the same cell keep their order.
std::vector<int> HilbertOrder(const ConstPoints& points);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_LOCALITY_H_
