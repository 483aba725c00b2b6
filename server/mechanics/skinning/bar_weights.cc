#include "server/mechanics/skinning/bar_weights.h"

#include <algorithm>

namespace phrenic {
namespace {

// An end of a bar: its vertex, and the nearest one of the driver.
struct BarEnd {
  Eigen::Vector3d at;
  SkinDrivers::Nearby nearby;
};

BarEnd EndAt(const SkinDrivers& drivers, int driver, const Points& bar) {
  BarEnd end{bar.col(0), {driver, 0, SkinDrivers::kAnywhere}};
  for (const auto& point : bar.colwise()) {
    const Neighbour found = drivers.search(driver).Nearest(point, end.nearby.distance);
    if (found.vertex >= 0 && found.distance < end.nearby.distance)
      end = {point, {driver, found.vertex, found.distance}};
  }
  return end;
}

}  // namespace

std::vector<SkinWeight> BarWeights(const SkinDrivers& drivers, const Points& bar) {
  const BarEnd first = EndAt(drivers, 0, bar), second = EndAt(drivers, 1, bar);
  const Eigen::Vector3d along = second.at - first.at;
  const double squared = std::max(along.squaredNorm(), 1e-12);  // [m^2]
  std::vector<SkinWeight> weights;
  for (int i = 0; i < bar.cols(); ++i) {
    const double t = std::clamp((bar.col(i) - first.at).dot(along) / squared, 0.0, 1.0);
    if (t < 1) drivers.AppendWeights(first.nearby, i, 1 - t, weights);
    if (t > 0) drivers.AppendWeights(second.nearby, i, t, weights);
  }
  return weights;
}

}  // namespace phrenic
