#include "server/mechanics/forces/polar.h"

#include <Eigen/Geometry>
#include <cmath>

namespace phrenic {
namespace {

// Unit normal of the plane of F's two columns; of one of its planes where they are parallel.
Eigen::Vector3d UnitNormal(const Gradient<2>& f, const Eigen::Vector3d& cross, double area) {
  if (area > 0) return cross / area;
  const Eigen::Vector3d longer = f.col(0).squaredNorm() > f.col(1).squaredNorm() ? f.col(0) : f.col(1);
  return longer.unitOrthogonal();
}

}  // namespace

Gradient<2> NearestRotation(const Gradient<2>& f) {
  const Eigen::Vector3d cross = f.col(0).cross(f.col(1));
  const double area = cross.norm();
  const double trace = std::sqrt(f.squaredNorm() + 2 * area);  // of S
  if (trace == 0) return Gradient<2>::Identity();
  const Eigen::Vector3d normal = UnitNormal(f, cross, area);
  Gradient<2> cofactor;
  cofactor.col(0) = f.col(1).cross(normal);
  cofactor.col(1) = normal.cross(f.col(0));
  return (f + cofactor) / trace;
}

}  // namespace phrenic
