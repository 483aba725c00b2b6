// Area-weighted vertex normals and vertex areas of a triangle surface.
#ifndef PHRENIC_SERVER_MESH_NORMALS_H_
#define PHRENIC_SERVER_MESH_NORMALS_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Unit normals, 3 x n; zero where a vertex is in no triangle with area.
Points VertexNormals(const ConstPoints& vertices, const Triangles& triangles);

// A third of the area of the triangles around each vertex [m^2].
Eigen::VectorXd VertexAreas(const ConstPoints& vertices, const Triangles& triangles);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_NORMALS_H_
