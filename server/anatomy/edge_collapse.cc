#include "server/anatomy/edge_collapse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

#include "absl/container/inlined_vector.h"

namespace phrenic::anatomy {
namespace {

// The vertices or triangles at a vertex; more than so many are on the heap.
using Fan = absl::InlinedVector<int, 10>;
using Around = absl::InlinedVector<int, 24>;

class Collapser {
 public:
  Collapser(double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles)
      : longest_(longest),
        points_(points),
        triangles_(triangles),
        fans_(points.size()),
        alive_(static_cast<size_t>(triangles.cols()), true),
        changed_(points.size(), true) {
    for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
      for (int k = 0; k < 3; ++k) fans_[triangles(k, t)].push_back(t);
    }
    for (int i = 0; i < static_cast<int>(points.size()); ++i) changes_.push_back(i);
  }

  // Collapses short edges, shortest first, at most one in each neighbourhood. Returns false if none could be collapsed.
  // An edge that no sweep collapsed is not tried again until a vertex of it has changed: its answer is the same.
  bool Sweep(double shortest) {
    const std::vector<Edge> edges = ShortEdges(shortest);
    for (const int i : changes_) changed_[i] = false;
    changes_.clear();
    bool collapsed = false;
    std::vector<bool>& touched = touched_;
    touched.assign(points_.size(), false);
    for (const auto& [length, a, b] : edges) {
      if (touched[a] || touched[b] || !CanCollapse(a, b)) continue;
      for (const int n : VerticesAround(a)) touched[n] = true;
      for (const int n : VerticesAround(b)) touched[n] = true;
      MarkChanged(a, b);
      Collapse(a, b);
      collapsed = true;
    }
    return collapsed;
  }

  // Removes dead vertices and triangles.
  void Compact() {
    std::vector<int> renumbered(points_.size(), -1);
    std::vector<Eigen::Vector3d> kept;
    for (size_t i = 0; i < points_.size(); ++i) {
      if (fans_[i].empty()) continue;
      renumbered[i] = static_cast<int>(kept.size());
      kept.push_back(points_[i]);
    }
    Eigen::Index count = 0;
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      if (!alive_[t]) continue;
      const Eigen::Vector3i v = triangles_.col(t);
      triangles_.col(count++) << renumbered[v[0]], renumbered[v[1]], renumbered[v[2]];
    }
    triangles_.conservativeResize(3, count);
    points_ = kept;
  }

 private:
  using Edge = std::tuple<double, int, int>;

  // Returns the edges shorter than `shortest` with a changed vertex, shortest first, each once.
  std::vector<Edge> ShortEdges(double shortest) const {
    std::vector<Edge> edges;
    for (const int vertex : changes_) {
      for (const int t : fans_[vertex]) {
        for (int k = 0; k < 3; ++k) {
          const int a = triangles_(k, t), b = triangles_((k + 1) % 3, t);
          // Of two changed vertices the first lists the edge.
          if (a >= b || (a != vertex && (b != vertex || changed_[a]))) continue;
          const double length = (points_[a] - points_[b]).norm();
          if (length < shortest) edges.emplace_back(length, a, b);
        }
      }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  void MarkChanged(int vertex) {
    if (changed_[vertex]) return;
    changed_[vertex] = true;
    changes_.push_back(vertex);
  }

  // Marks every vertex for which the answer of CanCollapse may change when a and b become one: those around a and b,
  // and those around the two vertices that lose a triangle.
  void MarkChanged(int a, int b) {
    const Around around_a = VerticesAround(a), around_b = VerticesAround(b);
    for (const int n : around_a) MarkChanged(n);
    for (const int n : around_b) MarkChanged(n);
    for (const int n : around_a) {
      if (!std::binary_search(around_b.begin(), around_b.end(), n)) continue;
      for (const int m : VerticesAround(n)) MarkChanged(m);
    }
  }

  Around VerticesAround(int vertex) const {
    Around around;
    for (const int t : fans_[vertex]) {
      for (int k = 0; k < 3; ++k) {
        if (triangles_(k, t) != vertex) around.push_back(triangles_(k, t));
      }
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }

  bool Has(int t, int vertex) const { return (triangles_.col(t).array() == vertex).any(); }

  // Checks the link condition, the length limit and the normals.
  bool CanCollapse(int a, int b) const {
    const Around around_a = VerticesAround(a), around_b = VerticesAround(b);
    if (!std::binary_search(around_a.begin(), around_a.end(), b)) return false;
    Around shared;
    std::set_intersection(around_a.begin(), around_a.end(), around_b.begin(), around_b.end(),
                          std::back_inserter(shared));
    if (shared.size() != 2 || fans_[shared[0]].size() <= 3 || fans_[shared[1]].size() <= 3) return false;
    const Eigen::Vector3d middle = (points_[a] + points_[b]) / 2;
    const auto too_far = [&](int n) { return (points_[n] - middle).norm() > longest_; };
    if (std::any_of(around_a.begin(), around_a.end(), too_far)) return false;
    if (std::any_of(around_b.begin(), around_b.end(), too_far)) return false;
    return KeepsNormals(a, b, middle) && KeepsNormals(b, a, middle);
  }

  // True if no remaining triangle at `moved` turns by more than 60 degrees or degenerates when it moves to `to`.
  bool KeepsNormals(int moved, int other, const Eigen::Vector3d& to) const {
    for (const int t : fans_[moved]) {
      if (Has(t, other)) continue;
      std::array<Eigen::Vector3d, 3> before, after;
      for (int k = 0; k < 3; ++k) {
        before[k] = points_[triangles_(k, t)];
        after[k] = triangles_(k, t) == moved ? to : before[k];
      }
      const Eigen::Vector3d n = (before[1] - before[0]).cross(before[2] - before[0]);
      const Eigen::Vector3d m = (after[1] - after[0]).cross(after[2] - after[0]);
      if (n.dot(m) < 0.5 * n.norm() * m.norm() || m.norm() < 1e-9) return false;
    }
    return true;
  }

  void Collapse(int a, int b) {
    points_[a] = (points_[a] + points_[b]) / 2;
    for (const int t : Fan(fans_[b])) {
      if (Has(t, a)) {
        alive_[t] = false;
        for (int k = 0; k < 3; ++k) {
          Fan& fan = fans_[triangles_(k, t)];
          fan.erase(std::remove(fan.begin(), fan.end(), t), fan.end());
        }
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        if (triangles_(k, t) == b) triangles_(k, t) = a;
      }
      fans_[a].push_back(t);
    }
    fans_[b].clear();
  }

  double longest_;
  std::vector<Eigen::Vector3d>& points_;
  Triangles& triangles_;
  std::vector<Fan> fans_;  // the triangles at each vertex
  std::vector<bool> alive_;
  std::vector<bool> changed_;  // since the sweep before began
  std::vector<int> changes_;   // the vertices that changed_ names
  std::vector<bool> touched_;  // in this sweep
};

}  // namespace

void CollapseShortEdges(double shortest, double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles) {
  Collapser collapser(longest, points, triangles);
  while (collapser.Sweep(shortest)) {
  }
  collapser.Compact();
}

}  // namespace phrenic::anatomy
