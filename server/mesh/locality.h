// An order of vertices in which those joined by edges are close together, for what is joined to be found in the cache.
#ifndef PHRENIC_SERVER_MESH_LOCALITY_H_
#define PHRENIC_SERVER_MESH_LOCALITY_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// The vertices that edges join, each once: reverse Cuthill-McKee (Cuthill and McKee 1969, George 1971), breadth first
// from a vertex of least degree, neighbours by their degree, backwards. The same edges give the same order. Time and
// memory grow with the edges; `vertices` is their number, above every index.
std::vector<int> LocalOrder(const Edges& edges, int vertices);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_LOCALITY_H_
