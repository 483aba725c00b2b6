// Coarsens a closed triangle surface by edge collapse.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_EDGE_COLLAPSE_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_EDGE_COLLAPSE_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Collapses edges shorter than `shortest` to their midpoints, shortest first, until none can be collapsed. A collapse
// must keep the surface manifold (link condition: the ends share exactly two neighbours), turn no triangle by more than
// 60 degrees and make no edge longer than `longest`. Renumbers vertices and triangles contiguously. Deterministic.
void CollapseShortEdges(double shortest, double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_EDGE_COLLAPSE_H_
