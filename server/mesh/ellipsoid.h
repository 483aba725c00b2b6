// The surface of an ellipsoid as triangles.
#ifndef PHRENIC_SERVER_MESH_ELLIPSOID_H_
#define PHRENIC_SERVER_MESH_ELLIPSOID_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// An octahedron with its edges cut into `divisions` (at least 1), each vertex pushed out onto the ellipsoid. `radii`
// are half its width, depth and height [m]. The upper half alone is open; its edge is region "rim".
Mesh EllipsoidSurface(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int divisions, bool upper_half);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_ELLIPSOID_H_
