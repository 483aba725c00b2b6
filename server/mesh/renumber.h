// Triangles and vertices taken out of a mesh, and what names them renumbered.
#ifndef PHRENIC_SERVER_MESH_RENUMBER_H_
#define PHRENIC_SERVER_MESH_RENUMBER_H_

#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Keeps the triangles t with keep[t], in their order.
void KeepTriangles(const std::vector<bool>& keep, Mesh& mesh);

// Vertex i is called name[i] from now on, in triangles, tetrahedra, edges and regions; the places stay.
void RenameVertices(const std::vector<int>& name, Mesh& mesh);

// Drops vertices that no triangle, tetrahedron or edge has.
void DropUnusedVertices(Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_RENUMBER_H_
