#include "server/anatomy/cartilage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/rib.h"
#include "server/anatomy/sternum.h"

namespace phrenic::anatomy {
namespace {

constexpr int kTrueRibs = 7;

// Where cartilages 1 to 7 meet the edge of the sternum.
Eigen::Vector3d SternalEnd(int number) {
  const double z = SternalNotch(number);
  return {SternumHalfWidth(z) + 1, SternumLine(z) + 1, z};
}

// Where cartilages 8 to 10 meet the one above: at its lower edge, in its lateral half.
Eigen::Vector3d EndOnCartilageAbove(int number) {
  constexpr int kSamples = 101;
  const Curve above = SmoothCurve(LeftCartilagePath(number - 1), kSamples);
  const size_t at = number == kTrueRibs + 1 ? 40 : 36;
  return above[at] - Eigen::Vector3d(0, 0, 7);
}

double AzimuthOf(const Eigen::Vector3d& point) {
  const Eigen::Vector2d q = CageSection(point.z(), 0).DiscCoordinates(point.head<2>());
  return std::atan2(q.x(), -q.y());
}

}  // namespace

Curve LeftCartilagePath(int number) {
  const Eigen::Vector3d from = LeftRibPath(number).back();
  const Eigen::Vector3d to = number <= kTrueRibs ? SternalEnd(number) : EndOnCartilageAbove(number);
  const double from_azimuth = AzimuthOf(from), to_azimuth = AzimuthOf(to);
  const double dip = number >= 5 && number <= 8 ? 2.5 * (number - 4) : 0;       // descends before it turns up
  const double late = number >= 5 && number <= 7 ? 1 + 0.2 * (number - 4) : 1;  // exponent; above 1 it rises late
  const int steps = number <= 4 ? 3 : 7;
  Curve path = {from};
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double azimuth = from_azimuth + (to_azimuth - from_azimuth) * t;
    const double rise = std::pow(t, late);
    const double z = from.z() + (to.z() - from.z()) * rise - dip * 4 * t * (1 - t) * (1 - t);
    const Eigen::Vector2d on_cage = CageSection(z, 0).Point({std::sin(azimuth), -std::cos(azimuth)});
    const Eigen::Vector3d straight = from + (to - from) * t;
    const double blend = t * t;  // from the cage's surface to the straight line that ends at `to`
    path.emplace_back((1 - blend) * on_cage.x() + blend * straight.x(),
                      (1 - blend) * on_cage.y() + blend * straight.y(), z);
  }
  path.push_back(to);
  return path;
}

Mesh LeftCartilage(int number, double edge_length) {
  const auto section = [number](double s, const Eigen::Vector3d& centre) {
    const double narrowing = number > kTrueRibs ? 2.2 * s : 1.0 * s;
    return TubeSection{6.6 - narrowing, 4.0 - 0.4 * narrowing, OutOfCage(centre)};
  };
  return Tube(LeftCartilagePath(number), section, edge_length);
}

}  // namespace phrenic::anatomy
