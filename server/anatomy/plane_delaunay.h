// Delaunay triangulation of points of the plane, by Boost.Polygon's exact Voronoi diagram.
#ifndef PHRENIC_SERVER_ANATOMY_PLANE_DELAUNAY_H_
#define PHRENIC_SERVER_ANATOMY_PLANE_DELAUNAY_H_

#include <Eigen/Core>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Anticlockwise triangles over the convex hull of the points, which must differ by more than 1e-8 of their extent.
// Where more than three points share an empty circle the polygon is fanned. Same points, same triangles.
Triangles PlaneDelaunay(const std::vector<Eigen::Vector2d>& points);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_PLANE_DELAUNAY_H_
