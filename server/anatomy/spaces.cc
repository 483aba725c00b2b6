#include "server/anatomy/spaces.h"

#include <algorithm>
#include <cmath>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/lung.h"
#include "server/anatomy/meshing/field.h"

namespace phrenic::anatomy {
namespace {

constexpr double kCageRadius = 105;  // turns disc coordinates into lengths [mm]

}  // namespace

double WithinCage(const Eigen::Vector3d& x, double inset) {
  // Disc coordinates are not lengths: across the cage the unit is its half width, front to back its half depth.
  constexpr double kHalfDepth = 80;
  thread_local LastCageSection last;
  return (last.At(x.z(), inset).DiscCoordinates(x.head<2>()).norm() - 1) * kHalfDepth;
}

double AboveDome(const Eigen::Vector3d& x) {
  constexpr double kStep = 0.01, kHighest = 228, kLowest = 95;  // of the domes, with the fold where they end [mm]
  if (x.z() > kHighest + 10 || x.z() < kLowest - 10) return x.z() - (x.z() > kHighest ? kHighest : kLowest);
  thread_local LastCageSection last;
  const Eigen::Vector2d q = last.At(x.z(), kDiaphragmInset).DiscCoordinates(x.head<2>());
  const double r = std::clamp(q.norm(), 2 * kStep, 1 - kStep);
  const Eigen::Vector2d unit = q / std::max(q.norm(), 1e-9);
  const double height = DomeHeight(r * unit);
  const double slope = (DomeHeight((r - kStep) * unit) - height) / (kStep * kCageRadius);
  return (x.z() - height) / std::hypot(1.0, slope);
}

double BelowDiaphragm(const Eigen::Vector3d& x, double gap) {
  constexpr double kBlend = 10;
  return SmoothMax(WithinCage(x, kDiaphragmInset + gap), AboveDome(x) + gap, kBlend);
}

double BetweenLungs(const Eigen::Vector3d& x, double gap) {
  constexpr double kBlend = 6, kPleurae = 1.2;
  const double lungs = kPleurae - LungField(x, x.x() > 0);  // neither lung crosses the midsagittal plane
  return SmoothMax(SmoothMax(lungs, gap - AboveDome(x), kBlend), WithinCage(x, kDiaphragmInset - 1), kBlend);
}

}  // namespace phrenic::anatomy
