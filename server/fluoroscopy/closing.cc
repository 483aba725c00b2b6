#include "server/fluoroscopy/closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "server/mesh/normals.h"

namespace phrenic::fluoroscopy {
namespace {

constexpr double kLargestGap = 0.5;  // length of all open edges, in roots of the surface's area

using DirectedEdges = std::vector<std::pair<int, int>>;

// The first vertex at the place of each vertex.
std::vector<int> Welded(const Points& vertices) {
  std::map<std::array<double, 3>, int> first;
  std::vector<int> welded;
  for (const auto& x : vertices.colwise()) {
    welded.push_back(first.emplace(std::array{x[0], x[1], x[2]}, static_cast<int>(welded.size())).first->second);
  }
  return welded;
}

// Edges that more triangles have in this direction than in the other, as often as that.
DirectedEdges OpenEdges(const Triangles& triangles, const std::vector<int>& welded) {
  std::map<std::pair<int, int>, int> balance;
  for (const auto& triangle : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const int a = welded[triangle[k]], b = welded[triangle[(k + 1) % 3]];
      if (a != b) balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  DirectedEdges open;
  for (const auto& [edge, count] : balance) {
    const auto directed = count > 0 ? edge : std::pair(edge.second, edge.first);
    open.insert(open.end(), static_cast<size_t>(std::abs(count)), directed);
  }
  return open;
}

// For each vertex of open edges, one vertex of all that are connected with it.
std::vector<int> Hubs(const DirectedEdges& open, size_t vertices) {
  std::vector<int> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [from, to] : open) {
    const auto [low, high] = std::minmax({root(from), root(to)});
    parent[high] = low;
  }
  for (size_t v = 0; v < vertices; ++v) parent[v] = root(static_cast<int>(v));
  return parent;
}

}  // namespace

std::optional<Triangles> ClosedTriangles(const Points& vertices, const Triangles& triangles) {
  if (triangles.cols() == 0) return std::nullopt;
  const DirectedEdges open = OpenEdges(triangles, Welded(vertices));
  double length = 0;
  for (const auto& [from, to] : open) length += (vertices.col(from) - vertices.col(to)).norm();
  if (length > kLargestGap * std::sqrt(VertexAreas(vertices, triangles).sum())) return std::nullopt;
  const std::vector<int> hub = Hubs(open, static_cast<size_t>(vertices.cols()));
  std::vector<Eigen::Vector3i> caps;
  for (const auto& [from, to] : open) {
    if (hub[from] != from && hub[from] != to) caps.emplace_back(to, from, hub[from]);
  }
  Triangles closed(3, triangles.cols() + static_cast<Eigen::Index>(caps.size()));
  closed.leftCols(triangles.cols()) = triangles;
  for (size_t i = 0; i < caps.size(); ++i) closed.col(triangles.cols() + static_cast<Eigen::Index>(i)) = caps[i];
  return closed;
}

}  // namespace phrenic::fluoroscopy
