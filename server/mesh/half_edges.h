// The half-edges of a triangle surface, sorted so that those of the same edge are consecutive.
#ifndef PHRENIC_SERVER_MESH_HALF_EDGES_H_
#define PHRENIC_SERVER_MESH_HALF_EDGES_H_

#include <algorithm>
#include <tuple>
#include <vector>

#include "server/mesh/bucket_sort.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// One edge of one triangle. An edge has one half-edge if it is a boundary edge, two (with opposite `forward` if the
// winding is consistent) if it is manifold, and more otherwise.
struct HalfEdge {
  int low, high;  // vertices, low < high unless the triangle repeats a vertex
  int triangle;
  bool forward;  // true if the triangle's winding runs from low to high
  bool operator<(const HalfEdge& other) const {
    return std::tie(low, high, triangle, forward) < std::tie(other.low, other.high, other.triangle, other.forward);
  }
};

// Returns the half-edges of all triangles, ascending. Time grows linearly with the triangles.
inline std::vector<HalfEdge> SortedHalfEdges(const Triangles& triangles) {
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(static_cast<size_t>(triangles.size()));
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, t), b = triangles((k + 1) % 3, t);
      half_edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  const int vertices = triangles.size() > 0 ? triangles.maxCoeff() + 1 : 0;
  BucketSort(half_edges, vertices, [](const HalfEdge& half_edge) { return half_edge.low; });
  return half_edges;
}

// Calls `use(first, last)` with the range [first, last) of half-edges of each edge. Requires: `half_edges` is sorted.
template <typename Use>
void ForEachEdge(const std::vector<HalfEdge>& half_edges, const Use& use) {
  for (auto first = half_edges.begin(); first != half_edges.end();) {
    auto last = first;
    while (last != half_edges.end() && last->low == first->low && last->high == first->high) ++last;
    use(first, last);
    first = last;
  }
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_HALF_EDGES_H_
