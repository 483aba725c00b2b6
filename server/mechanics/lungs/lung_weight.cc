#include "server/mechanics/lungs/lung_weight.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

constexpr double kStandardGravity = 9.81;  // [m/s^2]
constexpr double kWithoutAir = 0.3;        // volume of a lung without air, of that at rest, as in thorax_pressures.cc

}  // namespace

double LungWeight::ModulusAt(const Eigen::Vector3d& point) const {
  const double s = rise.dot(point - middle);
  return std::max(kWithoutAir, 1 + room * (1 - std::exp(-s))) * std::exp(s);
}

LungWeight WeightOfLungs(const v1::LungPair& lungs, double volume, const Eigen::Vector3d& middle,
                         const Eigen::Vector3d& down) {
  return {-lungs.recoil_rate() * kLungDensity * kStandardGravity * down, middle, lungs.room() / volume};
}

}  // namespace phrenic
