#include "server/mechanics/forces/polar.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace phrenic {
namespace {

constexpr double kFlat = 1e-4;       // det F / |F|^3 below which the singular value decomposition is used
constexpr int kMostIterations = 20;  // about five are typical
constexpr double kSettled = 1e-18;   // squared change of R at convergence; the next change would be its square

// Returns the unit normal of the plane of F's two columns; any normal to both if they are parallel.
Eigen::Vector3d UnitNormal(const Gradient<2>& f, const Eigen::Vector3d& cross, double area) {
  if (area > 0) return cross / area;
  const Eigen::Vector3d longer = f.col(0).squaredNorm() > f.col(1).squaredNorm() ? f.col(0) : f.col(1);
  return longer.unitOrthogonal();
}

Gradient<3> RotationBySingularValues(const Gradient<3>& f) {
  const Eigen::JacobiSVD<Gradient<3>> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Gradient<3> r = svd.matrixU() * svd.matrixV().transpose();
  if (r.determinant() > 0) return r;
  Gradient<3> u = svd.matrixU();
  u.col(2) = -u.col(2);  // reflects the direction of the smallest singular value, in which the element is inverted
  return u * svd.matrixV().transpose();
}

Gradient<3> Cofactor(const Gradient<3>& f) {
  Gradient<3> cofactor;
  for (int i = 0; i < 3; ++i) cofactor.col(i) = f.col((i + 1) % 3).cross(f.col((i + 2) % 3));
  return cofactor;
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

Gradient<3> NearestRotation(const Gradient<3>& f) {
  const double size = f.norm();
  if (f.determinant() <= kFlat * size * size * size) return RotationBySingularValues(f);
  Gradient<3> r = f;
  for (int i = 0; i < kMostIterations; ++i) {
    const Gradient<3> cofactor = Cofactor(r);
    const Gradient<3> inverse = cofactor / r.col(0).dot(cofactor.col(0));  // of R^T
    const double scale = std::sqrt(inverse.norm() / r.norm());
    const Gradient<3> next = 0.5 * (scale * r + inverse / scale);
    const double change = (next - r).squaredNorm();
    r = next;
    if (change < kSettled) break;
  }
  return r;
}

}  // namespace phrenic
