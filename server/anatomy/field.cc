#include "server/anatomy/field.h"

#include <algorithm>
#include <cmath>

namespace phrenic::anatomy {

double SmoothMin(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k / 4;
}

double Capsule(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double ra, double rb) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm() - (ra + t * (rb - ra));
}

}  // namespace phrenic::anatomy
