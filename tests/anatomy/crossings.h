// Detects self-intersections of a surface.
#ifndef PHRENIC_TESTS_ANATOMY_CROSSINGS_H_
#define PHRENIC_TESTS_ANATOMY_CROSSINGS_H_

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "server/mesh/topology.h"

namespace phrenic::anatomy {

// True if the segment p-q passes through the interior of the triangle a b c (Moeller and Trumbore 1997).
inline bool Pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a,
                    const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d along = q - p, u = b - a, v = c - a, h = along.cross(v);
  const double determinant = u.dot(h);
  if (std::abs(determinant) < 1e-18) return false;
  const Eigen::Vector3d s = p - a, k = s.cross(u);
  const double x = s.dot(h) / determinant, y = along.dot(k) / determinant, t = v.dot(k) / determinant;
  return x > 0 && y > 0 && x + y < 1 && t > 0 && t < 1;
}

// Returns the number of intersecting pairs of an edge and a triangle without a common vertex. Uses a hash grid with
// cells of size `cell` [m].
inline int SelfCrossings(const Mesh& mesh, double cell) {
  using Key = std::tuple<int, int, int>;
  const auto over = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, auto visit) {
    const Eigen::Vector3i from = (low / cell).array().floor().cast<int>(),
                          to = (high / cell).array().floor().cast<int>();
    for (int i = from.x(); i <= to.x(); ++i) {
      for (int j = from.y(); j <= to.y(); ++j) {
        for (int k = from.z(); k <= to.z(); ++k) visit(Key(i, j, k));
      }
    }
  };
  std::map<Key, std::vector<int>> cells;
  for (int t = 0; t < static_cast<int>(mesh.triangles.cols()); ++t) {
    const Eigen::Matrix3d corners = mesh.vertices(Eigen::all, mesh.triangles.col(t));
    over(corners.rowwise().minCoeff(), corners.rowwise().maxCoeff(), [&](const Key& key) { cells[key].push_back(t); });
  }
  const Edges edges = TriangleEdges(mesh.triangles);
  std::set<std::pair<int, int>> crossings;
  for (int e = 0; e < static_cast<int>(edges.cols()); ++e) {
    const int i = edges(0, e), j = edges(1, e);
    const Eigen::Vector3d p = mesh.vertices.col(i), q = mesh.vertices.col(j);
    over(p.cwiseMin(q), p.cwiseMax(q), [&](const Key& key) {
      const auto found = cells.find(key);
      if (found == cells.end()) return;
      for (const int t : found->second) {
        const Eigen::Vector3i v = mesh.triangles.col(t);
        if ((v.array() == i).any() || (v.array() == j).any()) continue;
        if (Pierces(p, q, mesh.vertices.col(v[0]), mesh.vertices.col(v[1]), mesh.vertices.col(v[2]))) {
          crossings.emplace(e, t);
        }
      }
    });
  }
  return static_cast<int>(crossings.size());
}

}  // namespace phrenic::anatomy

#endif  // PHRENIC_TESTS_ANATOMY_CROSSINGS_H_
