#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "server/mesh/repair.h"
#include "server/mesh/sides.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

void TurnTriangle(int t, Triangles& triangles) { std::swap(triangles(1, t), triangles(2, t)); }

// Adjacency of each triangle across edges of two: which, and whether they face the same way.
using Adjacency = std::vector<std::vector<std::pair<int, bool>>>;

Adjacency NeighboursOf(const Triangles& triangles) {
  Adjacency neighbours(static_cast<size_t>(triangles.cols()));
  ForEachEdge(SortedSides(triangles), [&](auto first, auto last) {
    if (last - first != 2) return;
    const auto second = first + 1;
    const bool agree = first->forward != second->forward;
    neighbours[first->triangle].emplace_back(second->triangle, agree);
    neighbours[second->triangle].emplace_back(first->triangle, agree);
  });
  return neighbours;
}

// The triangles that hang together with `seed` by edges of two, and whether each is to be turned to face as it does.
std::vector<std::pair<int, bool>> Agreed(int seed, const Adjacency& neighbours, std::vector<bool>& seen) {
  std::vector<std::pair<int, bool>> part = {{seed, false}};
  seen[seed] = true;
  for (size_t i = 0; i < part.size(); ++i) {
    const auto [t, turned] = part[i];
    for (const auto& [next, agree] : neighbours[t]) {
      if (seen[next]) continue;
      seen[next] = true;
      part.emplace_back(next, turned == agree);
    }
  }
  return part;
}

struct Part {
  std::vector<int> triangles;
  bool closed = true;
  double volume = 0;  // [m^3]
  Eigen::AlignedBox3d box;
};

Part Measured(const Mesh& mesh, const std::vector<std::pair<int, bool>>& members, const Adjacency& neighbours) {
  Part part;
  for (const auto& [t, turned] : members) {
    part.triangles.push_back(t);
    part.closed = part.closed && neighbours[t].size() == 3;
    for (const int vertex : mesh.triangles.col(t)) part.box.extend(mesh.vertices.col(vertex));
  }
  part.volume = SignedVolume(mesh.vertices, mesh.triangles(Eigen::all, part.triangles));
  return part;
}

}  // namespace

int Orient(Mesh& mesh) {
  const Triangles before = mesh.triangles;
  const Adjacency neighbours = NeighboursOf(mesh.triangles);
  std::vector<bool> seen(neighbours.size(), false);
  std::vector<Part> parts;
  for (int t = 0; t < static_cast<int>(neighbours.size()); ++t) {
    if (seen[t]) continue;
    const auto members = Agreed(t, neighbours, seen);
    const auto turned = std::count_if(members.begin(), members.end(), [](const auto& one) { return one.second; });
    const bool most = 2 * turned > static_cast<std::ptrdiff_t>(members.size());
    for (const auto& [triangle, turn] : members) {
      if (turn != most) TurnTriangle(triangle, mesh.triangles);
    }
    parts.push_back(Measured(mesh, members, neighbours));
  }
  for (const Part& part : parts) {
    const bool inside = std::any_of(parts.begin(), parts.end(), [&part](const Part& other) {
      return &other != &part && other.closed && other.box.contains(part.box);
    });
    if (!part.closed || part.volume >= 0 || inside) continue;
    for (const int t : part.triangles) TurnTriangle(t, mesh.triangles);
  }
  int turned = 0;
  for (Eigen::Index t = 0; t < before.cols(); ++t) turned += before.col(t) != mesh.triangles.col(t) ? 1 : 0;
  return turned;
}

}  // namespace phrenic
