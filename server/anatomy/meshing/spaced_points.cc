#include "server/anatomy/meshing/spaced_points.h"

#include <algorithm>
#include <cmath>

namespace phrenic::anatomy {

Eigen::Vector2d QuasiRandom(int64_t i) {
  constexpr double kPlastic = 1.32471795724474602596;  // x^3 = x + 1
  const double u = static_cast<double>(i) / kPlastic, v = static_cast<double>(i) / (kPlastic * kPlastic);
  return {u - std::floor(u), v - std::floor(v)};
}

SpacedPoints::SpacedPoints(double largest, double apart, double smallest)
    : cell_(std::max(largest, smallest) * apart), apart_(apart) {}

Eigen::Vector3i SpacedPoints::Cell(const Eigen::Vector3d& point) const {
  return (point / cell_).array().floor().cast<int>();
}

int64_t SpacedPoints::Key(const Eigen::Vector3i& cell) const {
  constexpr int64_t kSide = 1 << 20;
  return (static_cast<int64_t>(cell.x()) * kSide + cell.y()) * kSide + cell.z();
}

void SpacedPoints::Add(const Eigen::Vector3d& point, double spacing) {
  cells_[Key(Cell(point))].push_back({point, spacing});
}

bool SpacedPoints::TryAdd(const Eigen::Vector3d& point, double spacing) {
  const Eigen::Vector3i centre = Cell(point);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const auto found = cells_.find(Key(centre + Eigen::Vector3i(dx, dy, dz)));
        if (found == cells_.end()) continue;
        for (const Entry& entry : found->second) {
          if ((entry.point - point).norm() < apart_ * std::min(entry.spacing, spacing)) return false;
        }
      }
    }
  }
  Add(point, spacing);
  return true;
}

}  // namespace phrenic::anatomy
