#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "server/mesh/half_edges.h"
#include "server/mesh/repair.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

void FlipWinding(int t, Triangles& triangles) { std::swap(triangles(1, t), triangles(2, t)); }

// The neighbours of each triangle across edges with exactly two triangles, and whether their windings agree.
using Adjacency = std::vector<std::vector<std::pair<int, bool>>>;

Adjacency NeighboursOf(const Triangles& triangles) {
  Adjacency neighbours(static_cast<size_t>(triangles.cols()));
  ForEachEdge(SortedHalfEdges(triangles), [&](auto first, auto last) {
    if (last - first != 2) return;
    const auto second = first + 1;
    const bool agree = first->forward != second->forward;
    neighbours[first->triangle].emplace_back(second->triangle, agree);
    neighbours[second->triangle].emplace_back(first->triangle, agree);
  });
  return neighbours;
}

// Returns the triangles connected to `seed` across manifold edges, and whether each needs a flip to agree with `seed`.
std::vector<std::pair<int, bool>> ConsistentWith(int seed, const Adjacency& neighbours, std::vector<bool>& seen) {
  std::vector<std::pair<int, bool>> component = {{seed, false}};
  seen[seed] = true;
  for (size_t i = 0; i < component.size(); ++i) {
    const auto [t, flip] = component[i];
    for (const auto& [next, agree] : neighbours[t]) {
      if (seen[next]) continue;
      seen[next] = true;
      component.emplace_back(next, flip == agree);
    }
  }
  return component;
}

// A manifold-edge-connected component.
struct OrientedComponent {
  std::vector<int> triangles;
  bool closed = true;
  double volume = 0;  // [m^3]
  Eigen::AlignedBox3d box;
};

OrientedComponent Measure(const Mesh& mesh, const std::vector<std::pair<int, bool>>& members,
                          const Adjacency& neighbours) {
  OrientedComponent component;
  for (const auto& [t, flip] : members) {
    component.triangles.push_back(t);
    component.closed = component.closed && neighbours[t].size() == 3;
    for (const int vertex : mesh.triangles.col(t)) component.box.extend(mesh.vertices.col(vertex));
  }
  component.volume = SignedVolume(mesh.vertices, mesh.triangles(Eigen::all, component.triangles));
  return component;
}

}  // namespace

int Orient(Mesh& mesh) {
  const Triangles before = mesh.triangles;
  const Adjacency neighbours = NeighboursOf(mesh.triangles);
  std::vector<bool> seen(neighbours.size(), false);
  std::vector<OrientedComponent> components;
  for (int t = 0; t < static_cast<int>(neighbours.size()); ++t) {
    if (seen[t]) continue;
    const auto members = ConsistentWith(t, neighbours, seen);
    const auto flips = std::count_if(members.begin(), members.end(), [](const auto& one) { return one.second; });
    const bool majority = 2 * flips > static_cast<std::ptrdiff_t>(members.size());
    for (const auto& [triangle, flip] : members) {
      if (flip != majority) FlipWinding(triangle, mesh.triangles);
    }
    components.push_back(Measure(mesh, members, neighbours));
  }
  for (const OrientedComponent& component : components) {
    const bool inside = std::any_of(components.begin(), components.end(), [&component](const auto& other) {
      return &other != &component && other.closed && other.box.contains(component.box);
    });
    if (!component.closed || component.volume >= 0 || inside) continue;
    for (const int t : component.triangles) FlipWinding(t, mesh.triangles);
  }
  int flipped = 0;
  for (Eigen::Index t = 0; t < before.cols(); ++t) flipped += before.col(t) != mesh.triangles.col(t) ? 1 : 0;
  return flipped;
}

}  // namespace phrenic
