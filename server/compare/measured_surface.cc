#include "server/compare/measured_surface.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace phrenic::compare {

MeasuredSurface::MeasuredSurface(const ConstPoints& x, Triangles triangles)
    : x_(x),
      triangles_(std::move(triangles)),
      used_(triangles_.data(), triangles_.data() + triangles_.size()),
      tree_(x_, triangles_) {
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  tree_.Fit(x_, boxes_);
  for (Eigen::Index t = 0; t < triangles_.cols(); ++t) triangles_.col(t) = tree_.triangle(static_cast<int>(t));
}

void MeasuredSurface::MoveTo(const ConstPoints& x) {
  x_ = x;
  tree_.Fit(x_, boxes_);
}

double MeasuredSurface::Area() const {
  double twice = 0;
  for (const auto triangle : triangles_.colwise()) {
    const Eigen::Vector3d a = x_.col(triangle[0]), ab = x_.col(triangle[1]) - a, ac = x_.col(triangle[2]) - a;
    twice += ab.cross(ac).norm();
  }
  return twice / 2;
}

SurfacePoint MeasuredSurface::Nearest(const Eigen::Vector3d& point, double reach) const {
  constexpr double kSlack = 1e-6;  // relative allowance for rounding of `reach`
  constexpr double kLeast = 1e-9;  // absolute allowance [m]
  SurfacePoint nearest = tree_.Nearest(x_, boxes_, point, reach * (1 + kSlack) + kLeast);
  if (nearest.triangle >= 0) return nearest;
  return tree_.Nearest(x_, boxes_, point, std::numeric_limits<double>::infinity());
}

double MeasuredSurface::DistanceTo(int triangle, const Eigen::Vector3d& point) const {
  const Eigen::Vector3i vertices = tree_.triangle(triangle);
  const Eigen::Vector3d a = x_.col(vertices[0]), b = x_.col(vertices[1]), c = x_.col(vertices[2]);
  const Eigen::Vector3d weights = NearestWeights(a, b, c, point);
  return (weights[0] * a + weights[1] * b + weights[2] * c - point).norm();
}

}  // namespace phrenic::compare
