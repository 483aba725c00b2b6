// Removes triangles and vertices from a mesh and renumbers the indices that refer to them.
#ifndef PHRENIC_SERVER_MESH_RENUMBER_H_
#define PHRENIC_SERVER_MESH_RENUMBER_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Removes every triangle t with !keep[t]; the others keep their order. Vertices stay.
void KeepTriangles(const std::vector<bool>& keep, Mesh& mesh);

// Replaces vertex index i by number[i] in triangles, tetrahedra, edges and regions; regions end up sorted, each index
// once, unless every number[i] is i. mesh.vertices is unchanged.
void RenumberVertices(const std::vector<int>& number, Mesh& mesh);

// Removes vertices that no triangle, tetrahedron or edge uses, also from regions, and renumbers the others.
void DropUnusedVertices(Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_RENUMBER_H_
