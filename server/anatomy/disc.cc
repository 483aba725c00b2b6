#include "server/anatomy/disc.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/implicit_surface.h"
#include "server/anatomy/vertebra.h"

namespace phrenic::anatomy {

Mesh Disc(int number, double edge_length) {
  constexpr double kBulge = 0.7, kGap = 0.3, kRounded = 2, kOverlap = 1.5, kMaxEdge = 3.4, kDetail = 2,
                   kFar = 4;  // [mm]
  const VertebralBody above = BodyOfVertebra(number), below = BodyOfVertebra(number + 1);
  const double middle = (above.bottom + below.top) / 2, half_height = (above.bottom - below.top) / 2 + kOverlap;
  const double a = (above.width + below.width) / 4 + kBulge, b = (above.depth + below.depth) / 4 + kBulge;
  const Eigen::AngleAxisd upright(std::atan(SpineSlope(middle)), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d front(0, SpineFront(middle), middle);
  const Eigen::Vector3d centre = front + upright.inverse() * Eigen::Vector3d(0, b - kBulge, 0);
  const Field upper = VertebralBodyField(number), lower = VertebralBodyField(number + 1);
  const Field field = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d x = upright * (point - centre);
    const double radial = (Eigen::Vector2d(x.x() / a, x.y() / b).norm() - 1) * std::min(a, b);
    const double disc = SmoothMax(radial, std::abs(x.z()) - half_height, kRounded);
    return disc > kFar ? disc : SmoothMax(disc, kGap - std::min(upper(point), lower(point)), kRounded);
  };
  const double rise = half_height + b * std::abs(SpineSlope(middle)) + 2;
  const Eigen::Vector3d reach(a + 2, b + 4, rise);
  return ImplicitSurface(field, {centre - reach, centre + reach}, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
