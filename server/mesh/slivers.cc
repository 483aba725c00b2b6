#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "server/mesh/half_edges.h"
#include "server/mesh/renumber.h"
#include "server/mesh/repair.h"

namespace phrenic {
namespace {

constexpr int kRounds = 16;  // at most; a repair may create further slivers

bool Repeats(const Eigen::Vector3i& corner) {
  return corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
}

// Removes triangles with a repeated vertex and duplicates on the same three vertices: all of them if both windings
// occur, else all but the first. Returns how many.
int DropDuplicates(Mesh& mesh) {
  std::vector<bool> keep(static_cast<size_t>(mesh.triangles.cols()), true);
  std::map<std::array<int, 3>, std::vector<std::pair<int, bool>>> copies;  // sorted vertices -> triangle, winding
  for (int t = 0; t < static_cast<int>(mesh.triangles.cols()); ++t) {
    const Eigen::Vector3i corner = mesh.triangles.col(t);
    keep[t] = !Repeats(corner);
    if (!keep[t]) continue;
    std::array<int, 3> sorted = {corner[0], corner[1], corner[2]};
    std::sort(sorted.begin(), sorted.end());
    const auto least = std::min_element(corner.begin(), corner.end()) - corner.begin();
    copies[sorted].emplace_back(t, corner[(least + 1) % 3] == sorted[1]);
  }
  for (const auto& [vertices, triangles] : copies) {
    const auto forward = std::count_if(triangles.begin(), triangles.end(), [](const auto& one) { return one.second; });
    const bool both = forward > 0 && forward < static_cast<std::ptrdiff_t>(triangles.size());
    for (size_t i = both ? 0 : 1; i < triangles.size(); ++i) keep[triangles[i].first] = false;
  }
  const int dropped = static_cast<int>(std::count(keep.begin(), keep.end(), false));
  if (dropped > 0) KeepTriangles(keep, mesh);
  return dropped;
}

struct Sliver {
  int corner = -1;      // the one opposite the longest edge; -1 if the triangle is not a sliver
  bool needle = false;  // it has a short edge; otherwise it is a cap
};

Sliver Classify(const Mesh& mesh, int t, double height) {
  Eigen::Vector3d length;  // of the edge opposite each corner
  for (int k = 0; k < 3; ++k) {
    const auto a = mesh.vertices.col(mesh.triangles((k + 1) % 3, t)),
               b = mesh.vertices.col(mesh.triangles((k + 2) % 3, t));
    length[k] = (b - a).norm();
  }
  const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, t));
  const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, t)), c = mesh.vertices.col(mesh.triangles(2, t));
  Sliver sliver;
  int longest = 0;
  const double base = length.maxCoeff(&longest);
  if ((b - a).cross(c - a).norm() > height * base) return sliver;
  sliver.corner = longest;
  sliver.needle = length.minCoeff() < height;
  return sliver;
}

enum class Flip { kDone, kBoundary, kImpossible };

// Flips the edge of sliver `t` opposite `corner`. Returns kBoundary if the edge has no other triangle.
Flip FlipLongEdge(int t, int corner, const std::vector<HalfEdge>& half_edges, std::vector<bool>& touched,
                  Triangles& triangles) {
  const int c = triangles(corner, t), a = triangles((corner + 1) % 3, t), b = triangles((corner + 2) % 3, t);
  const auto of_edge = [&half_edges](int i, int j) {
    const auto before = [](const HalfEdge& half_edge, const std::pair<int, int>& edge) {
      return std::pair(half_edge.low, half_edge.high) < edge;
    };
    const std::pair edge(std::min(i, j), std::max(i, j));
    auto first = std::lower_bound(half_edges.begin(), half_edges.end(), edge, before), last = first;
    while (last != half_edges.end() && std::pair(last->low, last->high) == edge) ++last;
    return std::pair(first, last);
  };
  const auto [first, last] = of_edge(a, b);
  if (last - first == 1) return Flip::kBoundary;
  if (last - first != 2 || first->forward == (first + 1)->forward) return Flip::kImpossible;
  const int beyond = first->triangle == t ? (first + 1)->triangle : first->triangle;
  if (touched[t] || touched[beyond]) return Flip::kImpossible;
  const int d = triangles.col(beyond).sum() - a - b;
  if (const auto [from, to] = of_edge(c, d); c == d || from != to) return Flip::kImpossible;
  triangles.col(t) << a, d, c;
  triangles.col(beyond) << d, b, c;
  touched[t] = touched[beyond] = true;
  return Flip::kDone;
}

// Runs one round. Returns the number of slivers repaired.
int RepairSlivers(double height, Mesh& mesh) {
  const std::vector<HalfEdge> half_edges = SortedHalfEdges(mesh.triangles);
  const auto count = static_cast<size_t>(mesh.triangles.cols());
  std::vector<bool> touched(count, false), keep(count, true);
  std::vector<int> number(static_cast<size_t>(mesh.vertices.cols()));
  std::iota(number.begin(), number.end(), 0);
  int repaired = 0;
  for (int t = 0; t < static_cast<int>(count); ++t) {
    const Sliver sliver = Classify(mesh, t, height);
    if (sliver.corner < 0 || touched[t]) continue;
    if (sliver.needle) {
      // `corner` joins the two shorter edges; the shortest of the three is one of them.
      const int c = mesh.triangles(sliver.corner, t);
      const int a = mesh.triangles((sliver.corner + 1) % 3, t), b = mesh.triangles((sliver.corner + 2) % 3, t);
      const auto x = [&mesh](int vertex) { return mesh.vertices.col(vertex); };
      const int other = (x(a) - x(c)).norm() < (x(b) - x(c)).norm() ? a : b;
      if (number[c] != c || number[other] != other) continue;  // left to the next round
      number[std::max(c, other)] = std::min(c, other);
    } else {
      const Flip flip = FlipLongEdge(t, sliver.corner, half_edges, touched, mesh.triangles);
      if (flip == Flip::kImpossible) continue;
      keep[t] = flip != Flip::kBoundary;
    }
    ++repaired;
  }
  KeepTriangles(keep, mesh);
  // Follow chains of merges to their last vertex.
  for (int& vertex : number) {
    while (number[vertex] != vertex) vertex = number[vertex];
  }
  RenumberVertices(number, mesh);
  DropDuplicates(mesh);
  return repaired;
}

}  // namespace

int DropSlivers(double height, Mesh& mesh) {
  int repaired = DropDuplicates(mesh);
  for (int round = 0; round < kRounds; ++round) {
    const int now = RepairSlivers(height, mesh);
    repaired += now;
    if (now == 0) break;
  }
  DropUnusedVertices(mesh);
  return repaired;
}

}  // namespace phrenic
