#include "server/mesh/locality.h"

#include <algorithm>
#include <numeric>

namespace phrenic {
namespace {

// Neighbours of vertex i: of[first[i]] to of[first[i + 1] - 1].
struct Neighbours {
  std::vector<int> first, of;
  int Degree(int i) const { return first[i + 1] - first[i]; }
};

Neighbours FindNeighbours(const Edges& edges, int vertices) {
  Neighbours found{std::vector<int>(vertices + 1, 0), std::vector<int>(edges.size())};
  for (const int vertex : edges.reshaped()) ++found.first[vertex + 1];
  std::partial_sum(found.first.begin(), found.first.end(), found.first.begin());
  std::vector<int> next(found.first.begin(), found.first.end() - 1);
  for (const auto& edge : edges.colwise()) {
    found.of[next[edge[0]]++] = edge[1];
    found.of[next[edge[1]]++] = edge[0];
  }
  return found;
}

// Appends all that can be reached from `start`, breadth first.
void AppendComponent(int start, const Neighbours& neighbours, std::vector<bool>& seen, std::vector<int>& order) {
  const auto by_degree = [&neighbours](int a, int b) { return neighbours.Degree(a) < neighbours.Degree(b); };
  size_t next = order.size();
  order.push_back(start);
  seen[start] = true;
  for (; next < order.size(); ++next) {
    const int vertex = order[next];
    const auto level = static_cast<std::ptrdiff_t>(order.size());
    for (int k = neighbours.first[vertex]; k < neighbours.first[vertex + 1]; ++k) {
      const int neighbour = neighbours.of[k];
      if (seen[neighbour]) continue;
      seen[neighbour] = true;
      order.push_back(neighbour);
    }
    std::stable_sort(order.begin() + level, order.end(), by_degree);
  }
}

}  // namespace

std::vector<int> LocalOrder(const Edges& edges, int vertices) {
  const Neighbours neighbours = FindNeighbours(edges, vertices);
  std::vector<int> starts(vertices);
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(),
                   [&neighbours](int a, int b) { return neighbours.Degree(a) < neighbours.Degree(b); });
  std::vector<int> order;
  std::vector<bool> seen(vertices, false);
  for (const int start : starts) {
    if (!seen[start] && neighbours.Degree(start) > 0) AppendComponent(start, neighbours, seen, order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace phrenic
