// The sides of triangles, sorted so that those of one edge lie together.
#ifndef PHRENIC_SERVER_MESH_SIDES_H_
#define PHRENIC_SERVER_MESH_SIDES_H_

#include <algorithm>
#include <tuple>
#include <vector>

#include "server/mesh/bucket_sort.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct Side {
  int low, high;  // vertices
  int triangle;
  bool forward;  // the triangle runs from low to high
  bool operator<(const Side& other) const {
    return std::tie(low, high, triangle, forward) < std::tie(other.low, other.high, other.triangle, other.forward);
  }
};

inline std::vector<Side> SortedSides(const Triangles& triangles) {
  std::vector<Side> sides;
  sides.reserve(static_cast<size_t>(triangles.size()));
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(k, t), b = triangles((k + 1) % 3, t);
      sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  BucketSort(sides, triangles.size() > 0 ? triangles.maxCoeff() + 1 : 0, [](const Side& side) { return side.low; });
  return sides;
}

// Calls `use(first, last)` for the sides of each edge, [first, last).
template <typename Use>
void ForEachEdge(const std::vector<Side>& sides, const Use& use) {
  for (auto first = sides.begin(); first != sides.end();) {
    auto last = first;
    while (last != sides.end() && last->low == first->low && last->high == first->high) ++last;
    use(first, last);
    first = last;
  }
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_SIDES_H_
