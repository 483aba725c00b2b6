#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "server/mesh/half_edges.h"
#include "server/mesh/nearest.h"
#include "server/mesh/renumber.h"
#include "server/mesh/repair.h"

namespace phrenic {
namespace {

// The boundary edges of a mesh, and what is needed to find their counterparts.
struct Borders {
  std::vector<std::pair<int, int>> edges;
  std::set<std::pair<int, int>> joined;  // ends of every edge of the mesh, the lower first
};

Borders BordersOf(const Triangles& triangles) {
  Borders borders;
  ForEachEdge(SortedHalfEdges(triangles), [&](auto first, auto last) {
    borders.joined.emplace(first->low, first->high);
    if (last - first == 1) borders.edges.emplace_back(first->low, first->high);
  });
  return borders;
}

// Two boundary edges that lie opposite each other: a meets c, b meets d.
struct CutPair {
  double distance;  // the larger of both [m]
  int a, b, c, d;
  bool operator<(const CutPair& other) const {
    return std::tie(distance, a, b, c, d) < std::tie(other.distance, other.a, other.b, other.c, other.d);
  }
};

// Adds the pair if its ends are near each other and not joined.
void AddCutPair(const Mesh& mesh, const Borders& borders, double gap, std::pair<int, int> one,
                std::pair<int, int> other, std::vector<CutPair>& pairs) {
  const auto x = [&mesh](int i) { return mesh.vertices.col(i); };
  const auto length = [&x](std::pair<int, int> edge) { return (x(edge.first) - x(edge.second)).norm(); };
  const auto joined = [&borders](int i, int j) { return borders.joined.contains({std::min(i, j), std::max(i, j)}); };
  const double reach = std::min({gap, length(one) / 4, length(other) / 4});
  for (const auto& [c, d] : {other, std::pair(other.second, other.first)}) {
    const double distance = std::max((x(one.first) - x(c)).norm(), (x(one.second) - x(d)).norm());
    if (distance > reach || joined(one.first, c) || joined(one.second, d)) continue;
    pairs.push_back({distance, one.first, one.second, c, d});
  }
}

std::vector<CutPair> CutPairs(const Mesh& mesh, const Borders& borders, double gap) {
  Points middles(3, static_cast<Eigen::Index>(borders.edges.size()));
  for (size_t e = 0; e < borders.edges.size(); ++e) {
    const auto [a, b] = borders.edges[e];
    middles.col(static_cast<Eigen::Index>(e)) = (mesh.vertices.col(a) + mesh.vertices.col(b)) / 2;
  }
  const NearestSearch search(middles);
  std::vector<CutPair> pairs;
  for (int e = 0; e < static_cast<int>(borders.edges.size()); ++e) {
    for (const Neighbour& near : search.Within(middles.col(e), gap)) {
      if (near.vertex > e) AddCutPair(mesh, borders, gap, borders.edges[e], borders.edges[near.vertex], pairs);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

int JoinCuts(double gap, Mesh& mesh) {
  const Borders borders = BordersOf(mesh.triangles);
  if (borders.edges.empty() || !(gap > 0)) return 0;
  std::vector<int> number(static_cast<size_t>(mesh.vertices.cols()));
  std::iota(number.begin(), number.end(), 0);
  const auto root = [&number](int i) {
    while (number[i] != i) i = number[i];
    return i;
  };
  std::set<std::pair<int, int>> used;  // boundary edges, each of which joins one other
  const auto edge = [](int i, int j) { return std::pair(std::min(i, j), std::max(i, j)); };
  for (const CutPair& pair : CutPairs(mesh, borders, gap)) {
    const auto one = edge(pair.a, pair.b), other = edge(pair.c, pair.d);
    if (used.contains(one) || used.contains(other)) continue;
    used.insert({one, other});
    for (const auto& [i, j] : {std::pair(pair.a, pair.c), std::pair(pair.b, pair.d)}) {
      const int low = std::min(root(i), root(j)), high = std::max(root(i), root(j));
      number[high] = low;
    }
  }
  int merged = 0;
  for (int i = 0; i < static_cast<int>(number.size()); ++i) {
    number[i] = root(i);
    merged += number[i] == i ? 0 : 1;
  }
  if (merged == 0) return 0;
  RenumberVertices(number, mesh);
  DropUnusedVertices(mesh);
  return merged;
}

}  // namespace phrenic
