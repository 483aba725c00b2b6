#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "server/mesh/renumber.h"
#include "server/mesh/repair.h"
#include "server/mesh/sides.h"

namespace phrenic {
namespace {

constexpr int kRounds = 16;  // of slivers that come of others

bool Repeats(const Eigen::Vector3i& corner) {
  return corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
}

// Drops triangles that have a vertex twice; of those with the same three vertices, pairs that are back to back, and
// copies. Returns how many.
int DropFolded(Mesh& mesh) {
  std::vector<bool> keep(static_cast<size_t>(mesh.triangles.cols()), true);
  std::map<std::array<int, 3>, std::vector<std::pair<int, bool>>> copies;  // triangle, and which way it runs
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

// How a triangle is a sliver: `corner` is opposite its longest side.
struct Sliver {
  int corner = -1;  // -1: it is none
  bool needle = false;
};

Sliver Judge(const Mesh& mesh, int t, double height) {
  Eigen::Vector3d length;  // of the side opposite each corner
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

// Flips the side of sliver `t` that lies opposite `corner`, where one other triangle is beyond it.
enum class Flip { kDone, kOpen, kImpossible };

Flip FlipLongSide(int t, int corner, const std::vector<Side>& sides, std::vector<bool>& touched, Triangles& triangles) {
  const int c = triangles(corner, t), a = triangles((corner + 1) % 3, t), b = triangles((corner + 2) % 3, t);
  const auto of_edge = [&sides](int i, int j) {
    const auto before = [](const Side& side, const std::pair<int, int>& edge) {
      return std::pair(side.low, side.high) < edge;
    };
    const std::pair edge(std::min(i, j), std::max(i, j));
    auto first = std::lower_bound(sides.begin(), sides.end(), edge, before), last = first;
    while (last != sides.end() && std::pair(last->low, last->high) == edge) ++last;
    return std::pair(first, last);
  };
  const auto [first, last] = of_edge(a, b);
  if (last - first == 1) return Flip::kOpen;
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

// One round: how many slivers it dealt with.
int TreatSlivers(double height, Mesh& mesh) {
  const std::vector<Side> sides = SortedSides(mesh.triangles);
  const auto count = static_cast<size_t>(mesh.triangles.cols());
  std::vector<bool> touched(count, false), keep(count, true);
  std::vector<int> name(static_cast<size_t>(mesh.vertices.cols()));
  std::iota(name.begin(), name.end(), 0);
  int treated = 0;
  for (int t = 0; t < static_cast<int>(count); ++t) {
    const Sliver sliver = Judge(mesh, t, height);
    if (sliver.corner < 0 || touched[t]) continue;
    if (sliver.needle) {
      // Opposite the longest side the two others meet; the shortest is one of them.
      const int c = mesh.triangles(sliver.corner, t);
      const int a = mesh.triangles((sliver.corner + 1) % 3, t), b = mesh.triangles((sliver.corner + 2) % 3, t);
      const auto x = [&mesh](int vertex) { return mesh.vertices.col(vertex); };
      const int other = (x(a) - x(c)).norm() < (x(b) - x(c)).norm() ? a : b;
      if (name[c] != c || name[other] != other) continue;  // its turn comes in the next round
      name[std::max(c, other)] = std::min(c, other);
    } else {
      const Flip flip = FlipLongSide(t, sliver.corner, sides, touched, mesh.triangles);
      if (flip == Flip::kImpossible) continue;
      keep[t] = flip != Flip::kOpen;
    }
    ++treated;
  }
  KeepTriangles(keep, mesh);
  // A vertex that is to be merged is no other's target in the same round, or follows it there.
  for (int& vertex : name) {
    while (name[vertex] != vertex) vertex = name[vertex];
  }
  RenameVertices(name, mesh);
  DropFolded(mesh);
  return treated;
}

}  // namespace

int DropSlivers(double height, Mesh& mesh) {
  int treated = DropFolded(mesh);
  for (int round = 0; round < kRounds; ++round) {
    const int now = TreatSlivers(height, mesh);
    treated += now;
    if (now == 0) break;
  }
  DropUnusedVertices(mesh);
  return treated;
}

}  // namespace phrenic
