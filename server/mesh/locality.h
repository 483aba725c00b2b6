// Orders of vertices in which those joined by edges, or close in space, are close together: what is then asked of one
// after another is found in the cache.
#ifndef PHRENIC_SERVER_MESH_LOCALITY_H_
#define PHRENIC_SERVER_MESH_LOCALITY_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// The vertices that edges join, each once: reverse Cuthill-McKee (Cuthill and McKee 1969, George 1971), breadth first
// from a vertex of least degree, neighbours by their degree, backwards. The same edges give the same order. Time and
// memory grow with the edges; `vertices` is their number, above every index.
std::vector<int> LocalOrder(const Edges& edges, int vertices);

// The same where it is worth while: none where edges join vertices that are near by their numbers, and so meet in a
// core's cache as they come.
std::vector<int> LocalOrderIfFar(const Edges& edges, int vertices);

// All points along a Hilbert curve through the cube around them (Skilling, AIP Conf Proc 2004;707:381), of 1024 cells
// a side; those of one cell by their index.
std::vector<int> CurveOrder(const ConstPoints& points);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_LOCALITY_H_
