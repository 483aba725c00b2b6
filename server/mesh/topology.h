// Connectivity of a triangle surface: edges, boundary, connected components, manifoldness, Euler characteristic.
#ifndef PHRENIC_SERVER_MESH_TOPOLOGY_H_
#define PHRENIC_SERVER_MESH_TOPOLOGY_H_

#include <utility>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the undirected edges of the triangles (2 x n), each once, lower index first, sorted.
Edges TriangleEdges(const Triangles& triangles);

// Returns the pairs as a 2 x n matrix.
Edges ToEdges(const std::vector<std::pair<int, int>>& pairs);

// Returns mesh.edges if there are any, else the edges of the triangles.
Edges SpringEdges(const Mesh& mesh);

// Returns the vertices of boundary edges, which belong to one triangle only, ascending; empty for a closed surface.
std::vector<int> BoundaryVertices(const Triangles& triangles);

// Returns the non-manifold vertices, ascending: those whose triangles form more than one fan, a fan being triangles
// connected across edges at the vertex. Surfaces that touch in a point have them.
std::vector<int> PinchedVertices(const Triangles& triangles);

// Returns the triangles of each connected component (by shared vertices), ascending; components are ordered by their
// first triangle.
std::vector<std::vector<int>> Components(const Mesh& mesh);

struct SurfaceTopology {
  int vertices = 0;  // used by a triangle
  int edges = 0;
  int triangles = 0;
  int components = 0;            // connected by shared vertices
  int boundary_edges = 0;        // in exactly one triangle
  int non_manifold_edges = 0;    // in three triangles or more
  int misoriented_edges = 0;     // in two triangles, traversed in the same direction by both
  int degenerate_triangles = 0;  // a repeated vertex, or an area below 1e-14 m^2
  bool watertight() const { return boundary_edges == 0 && non_manifold_edges == 0 && misoriented_edges == 0; }
  int euler_characteristic() const { return vertices - edges + triangles; }
  // Sum of the components' genera, from V - E + F = 2 components - 2 genus. Requires: watertight().
  int genus() const { return components - euler_characteristic() / 2; }
};

SurfaceTopology AnalyseTopology(const Mesh& mesh);

// Returns the enclosed volume V = sum a . (b x c) / 6 [m^3] (divergence theorem); positive if triangles face outwards.
// Requires a closed surface.
double SignedVolume(const ConstPoints& vertices, const Triangles& triangles);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TOPOLOGY_H_
