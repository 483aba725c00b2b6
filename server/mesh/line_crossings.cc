#include "server/mesh/line_crossings.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

double Cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Adds the crossings of one triangle.
void AddCrossings(const Eigen::Matrix3d& corners, const Eigen::Vector2i& lines,
                  std::vector<std::vector<double>>& crossings) {
  const Eigen::Vector2d a = corners.col(0).head<2>(), b = corners.col(1).head<2>(), c = corners.col(2).head<2>();
  const double twice = Cross(b - a, c - a);
  if (twice == 0) return;
  const Eigen::Vector2i low = a.cwiseMin(b).cwiseMin(c).array().ceil().cast<int>().max(0);
  const Eigen::Vector2i high = a.cwiseMax(b).cwiseMax(c).array().floor().cast<int>().min(lines.array() - 1);
  for (int j = low.y(); j <= high.y(); ++j) {
    for (int i = low.x(); i <= high.x(); ++i) {
      const Eigen::Vector2d p(i, j);
      const double u = Cross(b - p, c - p) / twice, v = Cross(c - p, a - p) / twice, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      crossings[static_cast<std::size_t>(j) * lines.x() + i].push_back(corners.row(2).dot(Eigen::Vector3d(u, v, w)));
    }
  }
}

}  // namespace

std::vector<std::vector<double>> LineCrossings(const ConstPoints& vertices, const Triangles& triangles,
                                               const Eigen::Vector2i& lines) {
  // A small offset, so that no line passes through a vertex or an edge.
  const Eigen::Vector3d offset(1.234e-5, 2.345e-5, 0);
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(lines.x()) * lines.y());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = vertices.col(triangles(k, t)) + offset;
    AddCrossings(corners, lines, crossings);
  }
  for (std::vector<double>& along : crossings) std::sort(along.begin(), along.end());
  return crossings;
}

}  // namespace phrenic
