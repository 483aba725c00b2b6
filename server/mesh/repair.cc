#include "server/mesh/repair.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "server/mesh/nearest.h"
#include "server/mesh/renumber.h"
#include "server/mesh/sides.h"

namespace phrenic {
namespace {

// The pieces of surface between edges that are not of two triangles: the number of each triangle's.
std::vector<int> Pieces(const std::vector<Side>& sides, size_t triangles) {
  std::vector<int> parent(triangles);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  ForEachEdge(sides, [&](auto first, auto last) {
    if (last - first == 2) parent[root(first->triangle)] = root((first + 1)->triangle);
  });
  for (int t = 0; t < static_cast<int>(triangles); ++t) parent[t] = root(t);
  return parent;
}

}  // namespace

int Weld(double tolerance, Mesh& mesh) {
  const auto before = mesh.vertices.cols();
  if (before == 0) return 0;
  const NearestSearch search(mesh.vertices);
  std::vector<int> name(static_cast<size_t>(before), -1);
  for (int i = 0; i < static_cast<int>(before); ++i) {
    if (name[i] >= 0) continue;
    name[i] = i;
    for (const Neighbour& near : search.Within(mesh.vertices.col(i), std::max(tolerance, 1e-300))) {
      if (name[near.vertex] < 0) name[near.vertex] = i;
    }
  }
  RenameVertices(name, mesh);
  DropUnusedVertices(mesh);
  return static_cast<int>(before - mesh.vertices.cols());
}

int DropFins(Mesh& mesh) {
  const auto count = static_cast<size_t>(mesh.triangles.cols());
  const std::vector<Side> sides = SortedSides(mesh.triangles);
  const std::vector<int> piece = Pieces(sides, count);
  std::vector<bool> open(count, false), hangs(count, false), keep(count, true);
  ForEachEdge(sides, [&](auto first, auto last) {
    if (last - first == 1) open[piece[first->triangle]] = true;
    if (last - first < 3) return;
    for (auto side = first; side != last; ++side) hangs[piece[side->triangle]] = true;
  });
  for (size_t t = 0; t < count; ++t) keep[t] = !(open[piece[t]] && hangs[piece[t]]);
  const int dropped = static_cast<int>(std::count(keep.begin(), keep.end(), false));
  if (dropped == 0) return 0;
  KeepTriangles(keep, mesh);
  DropUnusedVertices(mesh);
  return dropped;
}

}  // namespace phrenic
