#include "server/anatomy/meshing/edge_collapse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "absl/container/inlined_vector.h"

namespace phrenic::anatomy {
namespace {

using Fan = absl::InlinedVector<int, 10>;

class Collapser {
 public:
  Collapser(double shortest, double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles)
      : shortest_(shortest),
        longest_(longest),
        points_(points),
        triangles_(triangles),
        fans_(points.size()),
        alive_(static_cast<size_t>(triangles.cols()), true),
        moved_(points.size(), true),
        changed_(points.size(), true),
        rings_(points.size(), 0) {
    for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
      for (int k = 0; k < 3; ++k) fans_[triangles(k, t)].push_back(t);
    }
    for (int i = 0; i < static_cast<int>(points.size()); ++i) moves_.push_back(i);
  }

  // Collapses short edges, shortest first, at most one in each neighbourhood. Returns false if none could be collapsed.
  // An edge that could not be collapsed is not tried again until one of its ends has changed: the answer is the same.
  bool Sweep() {
    Renew();
    const std::vector<char> may_have_changed = std::exchange(changed_, std::vector<char>(points_.size(), false));
    std::vector<char> touched(points_.size(), false);
    for (const auto& [length, a, b] : edges_) {
      if (touched[a] || touched[b] || !(may_have_changed[a] || may_have_changed[b]) || !CanCollapse(a, b)) continue;
      Mark(a, touched);
      Mark(b, touched);
      MarkChanged(a, b);
      Collapse(a, b);
      moved_[a] = moved_[b] = true;
      moves_.push_back(a);
    }
    return !moves_.empty();
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

  // Replaces the edges at vertices that have moved in edges_, the short ones, sorted by length.
  void Renew() {
    std::vector<Edge> fresh;
    for (const int vertex : moves_) {
      for (const int t : fans_[vertex]) {
        for (int k = 0; k < 3; ++k) {
          const int a = triangles_(k, t), b = triangles_((k + 1) % 3, t);
          // Of two moved vertices the first lists the edge.
          if (a >= b || (a != vertex && (b != vertex || moved_[a]))) continue;
          const double length = (points_[a] - points_[b]).norm();
          if (length < shortest_) fresh.emplace_back(length, a, b);
        }
      }
    }
    std::sort(fresh.begin(), fresh.end());
    std::erase_if(edges_, [this](const Edge& edge) { return moved_[std::get<1>(edge)] || moved_[std::get<2>(edge)]; });
    std::vector<Edge> merged(edges_.size() + fresh.size());
    std::merge(edges_.begin(), edges_.end(), fresh.begin(), fresh.end(), merged.begin());
    edges_ = std::move(merged);
    moved_.assign(points_.size(), false);
    moves_.clear();
  }

  // Marks a vertex and those around it.
  void Mark(int vertex, std::vector<char>& marked) const {
    for (const int t : fans_[vertex]) {
      for (int k = 0; k < 3; ++k) marked[triangles_(k, t)] = true;
    }
  }

  // Marks every vertex for which the answer of CanCollapse may change when a and b become one: those around a and b,
  // and those around the two vertices that lose a triangle.
  void MarkChanged(int a, int b) {
    Mark(a, changed_);
    Mark(b, changed_);
    for (const int t : fans_[a]) {
      if (!Has(t, b)) continue;
      for (int k = 0; k < 3; ++k) Mark(triangles_(k, t), changed_);
    }
  }

  bool Has(int t, int vertex) const {
    return triangles_(0, t) == vertex || triangles_(1, t) == vertex || triangles_(2, t) == vertex;
  }

  // Calls visit(n) once for each vertex n around `vertex`, whose place in rings_ was below `ring`, and sets it to that.
  // Ends at the first that returns false, and returns that.
  template <typename Visit>
  bool ForEachAround(int vertex, int ring, const Visit& visit) {
    for (const int t : fans_[vertex]) {
      for (int k = 0; k < 3; ++k) {
        const int n = triangles_(k, t);
        if (n == vertex || rings_[n] == ring) continue;
        const int before = std::exchange(rings_[n], ring);
        if (!visit(n, before)) return false;
      }
    }
    return true;
  }

  // Checks the link condition, the length limit and the normals.
  bool CanCollapse(int a, int b) {
    const Eigen::Vector3d middle = (points_[a] + points_[b]) / 2;
    const auto is_near = [&](int n) { return !((points_[n] - middle).norm() > longest_); };
    const int around_a = ++ring_, around_b = ++ring_;
    bool joined = false;
    const bool near_a = ForEachAround(a, around_a, [&](int n, int) {
      joined = joined || n == b;
      return is_near(n);
    });
    if (!near_a || !joined) return false;
    int shared = 0;
    const bool may = ForEachAround(b, around_b, [&](int n, int ring) {
      if (ring == around_a && (++shared > 2 || fans_[n].size() <= 3)) return false;
      return is_near(n);
    });
    if (!may || shared != 2) return false;
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

  double shortest_, longest_;
  std::vector<Eigen::Vector3d>& points_;
  Triangles& triangles_;
  std::vector<Fan> fans_;  // the triangles at each vertex
  std::vector<char> alive_;
  std::vector<Edge> edges_;    // the short ones, sorted
  std::vector<char> moved_;    // or died, since edges_ is as it is
  std::vector<int> moves_;     // the vertices that have moved, each once
  std::vector<char> changed_;  // in this sweep: CanCollapse may answer otherwise at these vertices
  std::vector<int> rings_;     // the last ring (ForEachAround) that has reached each vertex
  int ring_ = 0;
};

}  // namespace

void CollapseShortEdges(double shortest, double longest, std::vector<Eigen::Vector3d>& points, Triangles& triangles) {
  Collapser collapser(shortest, longest, points, triangles);
  while (collapser.Sweep()) {
  }
  collapser.Compact();
}

}  // namespace phrenic::anatomy
