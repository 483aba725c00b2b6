#include "server/anatomy/meshing/field.h"

#include <algorithm>
#include <cmath>

namespace phrenic::anatomy {

double SmoothMin(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

double SmoothMax(double a, double b, double k) { return -SmoothMin(-a, -b, k); }

double Capsule(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra, double rb) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm() - (ra + t * (rb - ra));
}

// The value of the quadric's norm, divided by the length of its gradient.
double Ellipsoid(const Eigen::Vector3d& x, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) {
  const Eigen::Vector3d scaled = (x - centre).cwiseQuotient(radii);
  const double norm = scaled.norm(), slope = scaled.cwiseQuotient(radii).norm();
  return slope > 1e-9 ? norm * (norm - 1) / slope : -radii.minCoeff();
}

}  // namespace phrenic::anatomy
