#include "server/mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace phrenic {
namespace {

constexpr int kLeafVertices = 32;  // a linear scan of so many is faster than descending further

// Returns a slightly larger squared distance: boxes round theirs, and a vertex in a box that ties is not to be missed.
double WithMargin(double squared) { return squared * (1 + 1e-9) + std::numeric_limits<double>::min(); }

double SquaredDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double x = a.x() - b.x(), y = a.y() - b.y(), z = a.z() - b.z();
  return x * x + y * y + z * z;
}

}  // namespace

NearestSearch::NearestSearch(const Points& points) : tree_(points, kLeafVertices), points_(3, points.cols()) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) points_.col(i) = points.col(tree_.order()[i]);
  tree_.Fit([this](int i, Eigen::AlignedBox3d& box) { box.extend(points_.col(i)); }, boxes_);
}

Neighbour NearestSearch::Nearest(const Eigen::Vector3d& point, double reach) const {
  int nearest = -1;
  double least = WithMargin(reach * reach), limit = WithMargin(least);
  tree_.Visit(
      boxes_, point, [&limit] { return limit; },
      [&](int i) {
        const double squared = SquaredDistance(point, points_.col(i));
        const int vertex = tree_.order()[i];
        if (!(squared < least || (squared == least && vertex < nearest))) return;
        nearest = vertex, least = squared, limit = WithMargin(squared);
      });
  const double distance = std::sqrt(least);
  if (nearest >= 0 && distance <= reach) return {nearest, distance};
  return {-1, std::numeric_limits<double>::infinity()};
}

std::vector<Neighbour> NearestSearch::Within(const Eigen::Vector3d& point, double radius) const {
  if (!(radius >= 0)) return {};
  std::vector<Neighbour> neighbours;
  const double most = radius * radius;
  tree_.Visit(
      boxes_, point, [limit = WithMargin(most)] { return limit; },
      [&](int i) {
        const double squared = SquaredDistance(point, points_.col(i));
        if (squared <= most) neighbours.push_back({tree_.order()[i], std::sqrt(squared)});
      });
  std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  });
  return neighbours;
}

}  // namespace phrenic
