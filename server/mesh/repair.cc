#include "server/mesh/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <vector>

#include "server/mesh/half_edges.h"
#include "server/mesh/nearest.h"
#include "server/mesh/renumber.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

// Returns for each triangle the representative of its piece: the triangles connected across manifold edges, that is
// edges with exactly two triangles (union-find).
std::vector<int> Pieces(const std::vector<HalfEdge>& half_edges, size_t triangles) {
  std::vector<int> parent(triangles);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  ForEachEdge(half_edges, [&](auto first, auto last) {
    if (last - first == 2) parent[root(first->triangle)] = root((first + 1)->triangle);
  });
  for (int t = 0; t < static_cast<int>(triangles); ++t) parent[t] = root(t);
  return parent;
}

constexpr double kCrumbShare = 0.05;  // most of the largest component's extent that a crumb has

// Returns the diagonal of the bounding box of these triangles [m].
double ExtentOf(const Mesh& mesh, const std::vector<int>& triangles) {
  Eigen::AlignedBox3d box;
  for (const int t : triangles) {
    for (const int vertex : mesh.triangles.col(t)) box.extend(Eigen::Vector3d(mesh.vertices.col(vertex)));
  }
  return box.diagonal().norm();
}

}  // namespace

int Weld(double tolerance, Mesh& mesh) {
  const auto before = mesh.vertices.cols();
  if (before == 0) return 0;
  const NearestSearch search(mesh.vertices);
  std::vector<int> number(static_cast<size_t>(before), -1);
  for (int i = 0; i < static_cast<int>(before); ++i) {
    if (number[i] >= 0) continue;
    number[i] = i;
    for (const Neighbour& near : search.Within(mesh.vertices.col(i), std::max(tolerance, 1e-300))) {
      if (number[near.vertex] < 0) number[near.vertex] = i;
    }
  }
  RenumberVertices(number, mesh);
  DropUnusedVertices(mesh);
  return static_cast<int>(before - mesh.vertices.cols());
}

int DropFins(Mesh& mesh) {
  const auto count = static_cast<size_t>(mesh.triangles.cols());
  const std::vector<HalfEdge> half_edges = SortedHalfEdges(mesh.triangles);
  const std::vector<int> piece = Pieces(half_edges, count);
  // By piece: has a boundary edge, has a non-manifold edge. A fin has both.
  std::vector<bool> open(count, false), attached(count, false), keep(count, true);
  ForEachEdge(half_edges, [&](auto first, auto last) {
    if (last - first == 1) open[piece[first->triangle]] = true;
    if (last - first < 3) return;
    for (auto half_edge = first; half_edge != last; ++half_edge) attached[piece[half_edge->triangle]] = true;
  });
  for (size_t t = 0; t < count; ++t) keep[t] = !(open[piece[t]] && attached[piece[t]]);
  const int dropped = static_cast<int>(std::count(keep.begin(), keep.end(), false));
  if (dropped == 0) return 0;
  KeepTriangles(keep, mesh);
  DropUnusedVertices(mesh);
  return dropped;
}

int DropCrumbs(double extent, Mesh& mesh) {
  const std::vector<std::vector<int>> components = Components(mesh);
  std::vector<double> extents;
  extents.reserve(components.size());
  for (const std::vector<int>& component : components) extents.push_back(ExtentOf(mesh, component));
  const double largest = extents.empty() ? 0 : *std::max_element(extents.begin(), extents.end());
  std::vector<bool> keep(static_cast<size_t>(mesh.triangles.cols()), true);
  int dropped = 0;
  for (size_t c = 0; c < components.size(); ++c) {
    if (extents[c] >= std::min(extent, kCrumbShare * largest)) continue;
    for (const int t : components[c]) keep[t] = false;
    ++dropped;
  }
  if (dropped == 0) return 0;
  KeepTriangles(keep, mesh);
  DropUnusedVertices(mesh);
  return dropped;
}

}  // namespace phrenic
