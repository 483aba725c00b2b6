// Area-weighted vertex normals and vertex areas of a triangle surface.
#ifndef PHRENIC_SERVER_MESH_NORMALS_H_
#define PHRENIC_SERVER_MESH_NORMALS_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns unit vertex normals (3 x n): the area-weighted mean of the normals of the triangles at each vertex. Zero for
// a vertex without a triangle of positive area.
Points VertexNormals(const ConstPoints& vertices, const Triangles& triangles);

// Returns one third of the area of the triangles at each vertex [m^2]; the sum is the area of the surface.
Eigen::VectorXd VertexAreas(const ConstPoints& vertices, const Triangles& triangles);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_NORMALS_H_
