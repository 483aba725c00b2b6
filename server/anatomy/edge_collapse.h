// Coarsens a closed triangle surface by merging the ends of short edges.
#ifndef PHRENIC_SERVER_ANATOMY_EDGE_COLLAPSE_H_
#define PHRENIC_SERVER_ANATOMY_EDGE_COLLAPSE_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Merges the ends of edges shorter than `shortest` at their middles, shortest first, until none is left that may be
// merged: the surface must stay a manifold (the ends share exactly two neighbours), no triangle may turn by more than
// 60 degrees and no edge grow past `longest`. Vertices and triangles are renumbered without gaps.
void CollapseShortEdges(double shortest, double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_EDGE_COLLAPSE_H_
