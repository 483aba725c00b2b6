#include "server/imaging/phantom_organs.h"

#include <algorithm>
#include <cmath>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"

namespace phrenic::imaging {
namespace {

constexpr double kBeside = 3.7;  // distance of an organ from the diaphragm's middle surface [mm]

Eigen::Vector2d Disc(const Eigen::Vector3d& point, double inset) {
  return anatomy::CageSection(point.z(), inset).DiscCoordinates(point.head<2>());
}

// Returns the approximate signed distance from the dome [mm], positive above: the height difference divided by the
// gradient's magnitude.
double AboveDome(const Eigen::Vector3d& point) {
  constexpr double kStep = 0.01, kRadius = 105;
  const Eigen::Vector2d q = Disc(point, anatomy::kDiaphragmInset);
  const double r = std::clamp(q.norm(), kStep, 1 - 2 * kStep);
  const Eigen::Vector2d unit = q / std::max(q.norm(), 1e-9);
  const double slope =
      (anatomy::DomeHeight((r - kStep) * unit) - anatomy::DomeHeight((r + kStep) * unit)) / (2 * kStep * kRadius);
  return (point.z() - anatomy::DomeHeight(q)) / std::hypot(1.0, slope);
}

// Below 1 inside the ellipsoid.
double Ellipsoid(const Eigen::Vector3d& point, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) {
  return (point - centre).cwiseQuotient(radii).norm();
}

bool InAbdomen(const Eigen::Vector3d& point) {
  if (Disc(point, anatomy::kDiaphragmInset + kBeside).norm() > 1) return false;
  return AboveDome(point) < -kBeside;
}

bool InHeart(const Eigen::Vector3d& point) {
  const bool in =
      Ellipsoid(point, {20, -42, 238}, {44, 48, 54}) < 1 || Ellipsoid(point, {2, -26, 248}, {34, 28, 52}) < 1;
  return in && AboveDome(point) > kBeside && Disc(point, 6).norm() < 1;
}

// The right lobe fills the right dome; the left lobe tapers to the left.
bool InLiver(const Eigen::Vector3d& point) {
  const double lowest = 70 + std::max(0.0, point.x() + 40) * 0.9;
  return InAbdomen(point) && point.x() < 52 && point.z() > lowest && (point.x() < -10 || point.y() < 15);
}

bool InStomach(const Eigen::Vector3d& point) {
  return InAbdomen(point) && !InLiver(point) && point.y() < 42 && point.x() > 24 && point.z() > 105;
}

bool InSpleen(const Eigen::Vector3d& point) {
  return InAbdomen(point) && point.y() > 46 && point.x() > 45 && point.z() > 82;
}

}  // namespace

bool InOrgan(v1::Organ organ, const Eigen::Vector3d& point) {
  switch (organ) {
    case v1::ORGAN_HEART:
      return InHeart(point);
    case v1::ORGAN_LIVER:
      return InLiver(point);
    case v1::ORGAN_STOMACH:
      return InStomach(point);
    case v1::ORGAN_SPLEEN:
      return InSpleen(point);
    default:
      return false;
  }
}

}  // namespace phrenic::imaging
