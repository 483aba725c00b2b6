// Triangulates the surface of an ellipsoid.
#ifndef PHRENIC_SERVER_MESH_ELLIPSOID_H_
#define PHRENIC_SERVER_MESH_ELLIPSOID_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns a subdivided octahedron, each edge cut into `divisions`, with every vertex projected onto the ellipsoid with
// this centre and these semi-axes along x, y and z [m]. Closed and facing outwards. With `upper_half` only z >=
// centre.z remains; its boundary loop is the region "rim". Requires: divisions >= 1.
Mesh EllipsoidSurface(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int divisions, bool upper_half);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_ELLIPSOID_H_
