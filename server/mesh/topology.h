// Connectivity of a triangle surface: edges, boundary, components, Euler characteristic.
#ifndef PHRENIC_SERVER_MESH_TOPOLOGY_H_
#define PHRENIC_SERVER_MESH_TOPOLOGY_H_

#include <utility>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// The undirected edges of the triangles, each once, lower index first, sorted.
Edges TriangleEdges(const Triangles& triangles);

// Pairs of vertices as edges.
Edges ToEdges(const std::vector<std::pair<int, int>>& pairs);

// The mesh's own edges where it has any, else its triangles' edges.
Edges SpringEdges(const Mesh& mesh);

// The vertices on edges that one triangle alone has, ascending; none for a closed surface.
std::vector<int> BorderVertices(const Triangles& triangles);

// The vertices whose triangles form more than one fan, ascending: surfaces that touch in a point, or a pinched one.
// Fans hang together by edges.
std::vector<int> PinchedVertices(const Triangles& triangles);

// The triangles of each component, ascending; the components in the order of their first triangles.
std::vector<std::vector<int>> Components(const Mesh& mesh);

struct SurfaceTopology {
  int vertices = 0;  // that a triangle uses
  int edges = 0;
  int triangles = 0;
  int components = 0;            // that share a vertex
  int boundary_edges = 0;        // in one triangle
  int non_manifold_edges = 0;    // in three or more
  int misoriented_edges = 0;     // crossed the same way by both triangles
  int degenerate_triangles = 0;  // a repeated vertex, or area below 1e-14 m^2
  bool watertight() const { return boundary_edges == 0 && non_manifold_edges == 0 && misoriented_edges == 0; }
  int euler_characteristic() const { return vertices - edges + triangles; }
  // Genus of a closed surface from V - E + F = 2 (components) - 2 genus.
  int genus() const { return components - euler_characteristic() / 2; }
};

SurfaceTopology AnalyseTopology(const Mesh& mesh);

// Enclosed volume by the divergence theorem [m^3]; positive when triangles face outwards.
double SignedVolume(const ConstPoints& vertices, const Triangles& triangles);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_TOPOLOGY_H_
