#include "server/anatomy/disc.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/implicit_surface.h"
#include "server/anatomy/vertebra.h"

namespace phrenic::anatomy {

Mesh Disc(int number, double edge_length) {
  constexpr double kBulge = 0.7, kGap = 0.1, kRounded = 1.5, kOverlap = 2, kMaxEdge = 3, kDetail = 2;  // [mm]
  const VertebralBody above = BodyOfVertebra(number), below = BodyOfVertebra(number + 1);
  const double middle = (above.bottom + below.top) / 2, half_height = (above.bottom - below.top) / 2 + kOverlap;
  const double a = (above.width + below.width) / 4 + kBulge, b = (above.depth + below.depth) / 4 + kBulge;
  const Eigen::Vector3d centre(0, SpineFront(middle) + b - kBulge, middle);
  const Eigen::AngleAxisd upright(std::atan(SpineSlope(middle)), Eigen::Vector3d::UnitX());
  const Field field = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d x = upright * (point - centre);
    const double radial = (std::hypot(x.x() / a, x.y() / b) - 1) * std::min(a, b);
    const double bones =
        kGap - std::min(VertebralBodyDistance(number, point), VertebralBodyDistance(number + 1, point));
    return SmoothMax(SmoothMax(radial, std::abs(x.z()) - half_height, kRounded), bones, kRounded);
  };
  const double rise = half_height + b * std::abs(SpineSlope(middle)) + 2;
  const Eigen::Vector3d reach(a + 2, b + 4, rise);
  return ImplicitSurface(field, {centre - reach, centre + reach}, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
