#include "server/anatomy/meshing/plane_region.h"

#include <algorithm>

namespace phrenic::anatomy {

namespace {
constexpr int kRows = 512;  // horizontal bands
}  // namespace

PlaneRegion::PlaneRegion(const std::vector<std::vector<Eigen::Vector2d>>& loops)
    : low_(loops[0][0]), high_(loops[0][0]), rows_(kRows) {
  for (const auto& loop : loops) {
    for (const Eigen::Vector2d& p : loop) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
  }
  for (const auto& loop : loops) {
    for (size_t i = 0; i < loop.size(); ++i) {
      const Segment side{loop[i], loop[(i + 1) % loop.size()]};
      const auto [from, to] = std::minmax({Row(side.first.y()), Row(side.second.y())});
      for (int row = from; row <= to; ++row) rows_[static_cast<size_t>(row)].push_back(side);
    }
  }
}

int PlaneRegion::Row(double y) const {
  const double row = (y - low_.y()) / (high_.y() - low_.y()) * kRows;
  return std::clamp(static_cast<int>(row), 0, kRows - 1);
}

bool PlaneRegion::Contains(const Eigen::Vector2d& point) const {
  if (point.y() < low_.y() || point.y() > high_.y()) return false;
  bool inside = false;
  for (const auto& [a, b] : rows_[static_cast<size_t>(Row(point.y()))]) {
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

}  // namespace phrenic::anatomy
