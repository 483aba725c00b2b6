#include "server/mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace phrenic {
namespace {

constexpr int kLeaf = 4;        // triangles
constexpr double kTie = 1e-10;  // relative difference of squared distances that counts as a tie

double Ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

}  // namespace

Eigen::Vector3d NearestWeights(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                               const Eigen::Vector3d& p) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const double ab_a = ab.dot(p - a), ac_a = ac.dot(p - a);
  if (ab_a <= 0 && ac_a <= 0) return {1, 0, 0};
  const double ab_b = ab.dot(p - b), ac_b = ac.dot(p - b);
  if (ab_b >= 0 && ac_b <= ab_b) return {0, 1, 0};
  const double at_c = ab_a * ac_b - ab_b * ac_a;
  if (at_c <= 0 && ab_a >= 0 && ab_b <= 0) {
    const double t = Ratio(ab_a, ab_a - ab_b);
    return {1 - t, t, 0};
  }
  const double ab_c = ab.dot(p - c), ac_c = ac.dot(p - c);
  if (ac_c >= 0 && ab_c <= ac_c) return {0, 0, 1};
  const double at_b = ab_c * ac_a - ab_a * ac_c;
  if (at_b <= 0 && ac_a >= 0 && ac_c <= 0) {
    const double t = Ratio(ac_a, ac_a - ac_c);
    return {1 - t, 0, t};
  }
  const double at_a = ab_b * ac_c - ab_c * ac_b;
  if (at_a <= 0 && ac_b >= ab_b && ab_c >= ac_c) {
    const double t = Ratio(ac_b - ab_b, (ac_b - ab_b) + (ab_c - ac_c));
    return {0, 1 - t, t};
  }
  const double sum = at_a + at_b + at_c;
  return {1 - Ratio(at_b, sum) - Ratio(at_c, sum), Ratio(at_b, sum), Ratio(at_c, sum)};
}

TriangleTree::TriangleTree(const ConstPoints& x, const Triangles& triangles) : triangles_(3, triangles.cols()) {
  Points centroids(3, triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    centroids.col(t) = (x.col(triangles(0, t)) + x.col(triangles(1, t)) + x.col(triangles(2, t))) / 3;
  }
  tree_ = BoxTree(centroids, kLeaf);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) triangles_.col(t) = triangles.col(tree_.order()[t]);
  boundary_vertex_.assign(static_cast<size_t>(x.cols()), false);
  FindBoundary();
}

void TriangleTree::FindBoundary() {
  std::map<std::pair<int, int>, int> triangles_at;  // edge -> number of triangles
  const auto edge = [this](Eigen::Index t, int opposite) {
    return std::minmax({triangles_((opposite + 1) % 3, t), triangles_((opposite + 2) % 3, t)});
  };
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    for (int i = 0; i < 3; ++i) ++triangles_at[edge(t, i)];
  }
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
    Eigen::Vector3i open = Eigen::Vector3i::Zero();
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = edge(t, i);
      open[i] = triangles_at[{a, b}] == 1;
      if (open[i] != 0) boundary_vertex_[a] = boundary_vertex_[b] = true;
    }
    boundary_edge_.push_back(open);
  }
}

void TriangleTree::Fit(const ConstPoints& x, Boxes& boxes) const {
  const auto extend = [&](int t, Eigen::AlignedBox3d& box) {
    for (int i = 0; i < 3; ++i) box.extend(x.col(triangles_(i, t)));
  };
  tree_.Fit(extend, boxes);
}

void TriangleTree::Try(const ConstPoints& x, const Eigen::Vector3d& point, int t, SurfacePoint& best) const {
  const Eigen::Vector3i vertices = triangles_.col(t);
  const Eigen::Vector3d a = x.col(vertices[0]), b = x.col(vertices[1]), c = x.col(vertices[2]);
  const Eigen::Vector3d weights = NearestWeights(a, b, c, point);
  const Eigen::Vector3d offset = weights[0] * a + weights[1] * b + weights[2] * c - point;
  const double squared = offset.squaredNorm();
  if (!(squared <= best.squared * (1 + kTie))) return;
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double facing = Ratio(normal.dot(offset), normal.norm() * offset.norm());
  if (squared >= best.squared * (1 - kTie) && std::abs(facing) <= std::abs(best.facing)) return;
  best = {t, weights, offset, squared, facing, false};
  for (int i = 0; i < 3; ++i) {
    if (weights[i] == 1) best.on_boundary = boundary_vertex_[vertices[i]];
    if (weights[i] == 0 && boundary_edge_[t][i] != 0) best.on_boundary = true;
  }
}

SurfacePoint TriangleTree::Nearest(const ConstPoints& x, const Boxes& boxes, const Eigen::Vector3d& point,
                                   double reach) const {
  SurfacePoint best;
  best.squared = reach * reach;
  const auto limit = [&best] { return best.squared * (1 + kTie); };
  tree_.Visit(boxes, point, limit, [&](int t) { Try(x, point, t, best); });
  return best;
}

}  // namespace phrenic
