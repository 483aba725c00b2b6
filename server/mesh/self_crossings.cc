#include "server/mesh/self_crossings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "server/mesh/topology.h"

namespace phrenic {
namespace {

// A cell of the grid and a triangle whose box reaches into it.
struct InCell {
  std::uint64_t cell;
  int triangle;
  bool operator<(const InCell& other) const {
    return cell != other.cell ? cell < other.cell : triangle < other.triangle;
  }
};

// True if the segment p-q passes through the interior of the triangle a b c (Moeller and Trumbore 1997).
bool Pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  const Eigen::Vector3d along = q - p, u = b - a, v = c - a, h = along.cross(v);
  const double determinant = u.dot(h);
  if (std::abs(determinant) < 1e-18) return false;
  const Eigen::Vector3d s = p - a, k = s.cross(u);
  const double x = s.dot(h) / determinant, y = along.dot(k) / determinant, t = v.dot(k) / determinant;
  return x > 0 && y > 0 && x + y < 1 && t > 0 && t < 1;
}

// Calls visit(key) for each cell that a box reaches into. Keys of distant cells may be equal: that costs time only.
template <typename Visit>
void ForEachCell(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double size, const Visit& visit) {
  const Eigen::Vector3i from = (low / size).array().floor().cast<int>(), to = (high / size).array().floor().cast<int>();
  const auto bits = [](int i) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(i)) & 0x1fffff; };
  for (int i = from.x(); i <= to.x(); ++i) {
    for (int j = from.y(); j <= to.y(); ++j) {
      for (int k = from.z(); k <= to.z(); ++k) visit(bits(i) << 42 | bits(j) << 21 | bits(k));
    }
  }
}

std::vector<InCell> Sorted(const ConstPoints& x, const Triangles& triangles, double size) {
  std::vector<InCell> cells;
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    const Eigen::Matrix3d corners = x(Eigen::all, triangles.col(t));
    ForEachCell(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff(), size, [&](std::uint64_t cell) {
      cells.push_back({cell, t});
    });
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

}  // namespace

int SelfCrossings(const ConstPoints& x, const Triangles& triangles, double cell) {
  const std::vector<InCell> cells = Sorted(x, triangles, cell);
  const Edges edges = TriangleEdges(triangles);
  int crossings = 0;
  std::vector<int> near;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const int i = edges(0, e), j = edges(1, e);
    const Eigen::Vector3d p = x.col(i), q = x.col(j);
    near.clear();
    ForEachCell(p.cwiseMin(q), p.cwiseMax(q), cell, [&](std::uint64_t key) {
      for (auto at = std::lower_bound(cells.begin(), cells.end(), InCell{key, 0}); at != cells.end() && at->cell == key;
           ++at) {
        near.push_back(at->triangle);
      }
    });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const int t : near) {
      const Eigen::Vector3i v = triangles.col(t);
      if ((v.array() == i).any() || (v.array() == j).any()) continue;
      if (Pierces(p, q, x.col(v[0]), x.col(v[1]), x.col(v[2]))) ++crossings;
    }
  }
  return crossings;
}

}  // namespace phrenic
