// Delaunay triangulation of points in the plane, the dual of Boost.Polygon's exact Voronoi diagram.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_PLANE_DELAUNAY_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_PLANE_DELAUNAY_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns counter-clockwise triangles (3 x n) that cover the convex hull. More than three cocircular points become a
// fan. Requires: points differ by more than 1e-8 of their extent. Deterministic.
Triangles PlaneDelaunay(const std::vector<Eigen::Vector2d>& points);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_PLANE_DELAUNAY_H_
