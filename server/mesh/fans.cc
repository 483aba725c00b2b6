#include "server/mesh/fans.h"

#include <numeric>

#include "server/mesh/half_edges.h"

namespace phrenic {
namespace {

// Returns the representative of i in a union-find forest, halving the path.
int FanOf(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Returns the corner of a triangle at a vertex.
int CornerAt(const Triangles& triangles, int triangle, int vertex) {
  for (int k = 0; k < 2; ++k) {
    if (triangles(k, triangle) == vertex) return 3 * triangle + k;
  }
  return 3 * triangle + 2;
}

}  // namespace

std::vector<int> CornerFans(const Triangles& triangles, bool part_bodies) {
  std::vector<int> parent(static_cast<size_t>(triangles.size()));
  std::iota(parent.begin(), parent.end(), 0);
  ForEachEdge(SortedHalfEdges(triangles), [&](auto first, auto last) {
    if (part_bodies && last - first > 2 && (last - first) % 2 == 0) return;
    for (auto half_edge = first + 1; half_edge != last; ++half_edge) {
      for (const int vertex : {first->low, first->high}) {
        const int a = CornerAt(triangles, (half_edge - 1)->triangle, vertex);
        const int b = CornerAt(triangles, half_edge->triangle, vertex);
        parent[FanOf(parent, b)] = FanOf(parent, a);
      }
    }
  });
  for (int corner = 0; corner < static_cast<int>(parent.size()); ++corner) parent[corner] = FanOf(parent, corner);
  return parent;
}

}  // namespace phrenic
