// Improves the triangles of a surface by exchanging diagonals.
#ifndef PHRENIC_SERVER_ANATOMY_EDGE_FLIPS_H_
#define PHRENIC_SERVER_ANATOMY_EDGE_FLIPS_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Flips until every inner edge is Delaunay on the surface (the two angles facing it sum to at most pi, measured in
// `points`), as long as the triangles stay anticlockwise in the plane. Border edges stay.
void FlipToDelaunay(const std::vector<Eigen::Vector2d>& plane, const std::vector<Eigen::Vector3d>& points,
                    Triangles& triangles);

// The same for a closed surface: a flip may turn no triangle by more than 60 degrees from its neighbour's facing and
// may not make an edge that is there already.
void FlipToDelaunay(const std::vector<Eigen::Vector3d>& points, Triangles& triangles);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_EDGE_FLIPS_H_
