#include "server/phantom/hounsfield.h"

#include <cmath>
#include <cstdint>

namespace phrenic::phantom {
namespace {

using fluoroscopy::CoefficientOf;
using fluoroscopy::Tissue;

constexpr double kWater = 100 * 0.1937;                                              // [1/m]
constexpr double kRibDensity = 1.4, kCorticalDensity = 1.92, kMarrowDensity = 1.02;  // [g/cm^3]

constexpr double kGrain = 0.01;  // [m]

// Returns a number in [-1, 1] of the point of a lattice (the finaliser of SplitMix64).
double ValueAt(const Eigen::Vector3i& point) {
  auto hash = static_cast<std::uint64_t>(static_cast<std::uint32_t>(point.x()));
  hash = hash * 1'000'003 + static_cast<std::uint32_t>(point.y());
  hash = hash * 1'000'003 + static_cast<std::uint32_t>(point.z());
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111eb;
  hash ^= hash >> 31;
  return std::ldexp(static_cast<double>(hash >> 11), -52) - 1;
}

double OfCoefficient(double coefficient) { return 1000 * (coefficient - kWater) / kWater; }

}  // namespace

double HounsfieldOf(Tissue tissue) {
  if (tissue != Tissue::kRib) return OfCoefficient(CoefficientOf(tissue));
  constexpr double kCortical = (kRibDensity - kMarrowDensity) / (kCorticalDensity - kMarrowDensity);
  return OfCoefficient(kCortical * CoefficientOf(Tissue::kCortical) + (1 - kCortical) * CoefficientOf(Tissue::kMarrow));
}

double LungHounsfield(double ratio) { return OfCoefficient(fluoroscopy::LungCoefficient(1, ratio)); }

double GrainAt(const Eigen::Vector3d& place) {
  const Eigen::Vector3d at = place / kGrain, low = at.array().floor();
  const Eigen::Vector3d t = at - low, weight = t.array().square() * (3 - 2 * t.array());
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) share *= step[axis] != 0 ? weight[axis] : 1 - weight[axis];
    value += share * ValueAt(low.cast<int>() + step);
  }
  return value;
}

}  // namespace phrenic::phantom
