#include "server/mechanics/breathing/inner_wall.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace phrenic {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi;
constexpr int kAzimuths = 96, kHeights = 80;  // of the table
constexpr double kLeastRadius = 1e-6;           // below it a point has no azimuth [m]
constexpr int kLevels = 60;                     // of the wall between a loop and its top

// The four entries around a point of the table, and where it lies between them.
struct Cell {
  int a, b, c, d;  // below left, below right, above left, above right
  double u, v;     // fractions to the right and upwards
  bool inside;     // not beyond the table's lower or upper border

  double Value(const std::vector<double>& of) const {
    return (1 - v) * ((1 - u) * of[a] + u * of[b]) + v * ((1 - u) * of[c] + u * of[d]);
  }
  double ByU(const std::vector<double>& of) const { return (1 - v) * (of[b] - of[a]) + v * (of[d] - of[c]); }
  double ByV(const std::vector<double>& of) const { return (1 - u) * (of[c] - of[a]) + u * (of[d] - of[b]); }
};

Cell CellAt(double azimuth, double height) {
  const double column = azimuth * kAzimuths / kFullTurn, row = std::clamp(height * (kHeights - 1), 0.0, kHeights - 1.0);
  const int left = std::min(static_cast<int>(column), kAzimuths - 1), below = std::min(static_cast<int>(row), kHeights - 2);
  const int right = (left + 1) % kAzimuths, low = below * kAzimuths, high = low + kAzimuths;
  return {low + left, low + right, high + left, high + right, column - left, row - below, height > 0 && height < 1};
}

double ConeOver(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return a.dot(b.cross(c)) / 6;
}

}  // namespace

absl::StatusOr<InnerWall> InnerWall::Make(const Points& rest, const std::vector<Points>& moved) {
  const auto grid = WallGrid::Find(rest);
  if (!grid.ok()) return grid.status();
  InnerWall wall(*grid);
  wall.rest_ = rest;
  wall.moved_ = moved;
  wall.bottom_ = rest(2, 0);
  wall.height_ = rest(2, grid->columns() * (grid->star_rows() - 1)) - wall.bottom_;
  wall.Tabulate();
  return wall;
}

void InnerWall::Tabulate() {
  const CageFit fit;
  radius_.resize(kAzimuths * kHeights);
  for (auto& coefficient : change_) coefficient.resize(radius_.size());
  for (int entry = 0; entry < kAzimuths * kHeights; ++entry) {
    const double azimuth = kFullTurn * (entry % kAzimuths) / kAzimuths;
    const double z = bottom_ + height_ * (entry / kAzimuths) / (kHeights - 1);
    const GridCoordinates there = grid_.Locate(rest_, azimuth, z, grid_.Guess(rest_, azimuth, z));
    radius_[entry] = grid_.Polar(grid_.At(rest_, there)).radius;
    CageQuadratic change;
    for (size_t k = 0; k < moved_.size(); ++k) {
      const GridCoordinates now = grid_.Locate(moved_[k], azimuth, z, there);
      fit.Add(k, grid_.Polar(grid_.At(moved_[k], now)).radius - radius_[entry], change);
    }
    for (size_t j = 0; j < change.c.size(); ++j) change_[j][entry] = change.c[j];
  }
}

void InnerWall::Evaluate(const CagePosition& k, WallTable& table) const {
  const size_t entries = radius_.size();
  table.radius.resize(entries);
  table.by_pump.resize(entries);
  table.by_bucket.resize(entries);
  const auto& [p, b, pp, bb, pb] = change_;
  for (size_t i = 0; i < entries; ++i) {
    table.by_pump[i] = p[i] + 2 * pp[i] * k.pump + pb[i] * k.bucket;
    table.by_bucket[i] = b[i] + 2 * bb[i] * k.bucket + pb[i] * k.pump;
    // A quadratic: its change is the mean of its slopes at both ends.
    table.radius[i] =
        radius_[i] + k.pump * (p[i] + table.by_pump[i]) / 2 + k.bucket * (b[i] + table.by_bucket[i]) / 2;
  }
}

WallGap InnerWall::Gap(const WallTable& table, const Eigen::Vector3d& point) const {
  const PolarPoint polar = grid_.Polar(point);
  const Cell cell = CellAt(polar.azimuth, (polar.z - bottom_) / height_);
  const double r = std::max(polar.radius, kLeastRadius);
  const Eigen::Vector3d outward(std::sin(polar.azimuth), -std::cos(polar.azimuth), 0);
  const Eigen::Vector3d around(std::cos(polar.azimuth), std::sin(polar.azimuth), 0);
  const double by_azimuth = cell.ByU(table.radius) * kAzimuths / kFullTurn;
  const double by_z = cell.inside ? cell.ByV(table.radius) * (kHeights - 1) / height_ : 0;
  return {.gap = polar.radius - cell.Value(table.radius),
          .gradient = outward - by_azimuth / r * around - by_z * Eigen::Vector3d::UnitZ(),
          .by_pump = -cell.Value(table.by_pump),
          .by_bucket = -cell.Value(table.by_bucket)};
}

InnerWall::Follower InnerWall::Follow(const Eigen::Vector3d& point) const {
  const PolarPoint polar = grid_.Polar(point);
  const GridCoordinates there =
      grid_.Locate(rest_, polar.azimuth, polar.z, grid_.Guess(rest_, polar.azimuth, polar.z));
  const Eigen::Vector3d from = grid_.At(rest_, there);
  const CageFit fit;
  Follower follower;
  for (size_t k = 0; k < moved_.size(); ++k) {
    const Eigen::Vector3d shift = grid_.At(moved_[k], there) - from;
    for (int axis = 0; axis < 3; ++axis) fit.Add(k, shift[axis], follower.shift[axis]);
  }
  return follower;
}

InnerWall::Volumes InnerWall::VolumesAbove(const std::vector<Eigen::Vector3d>& loop,
                                           const Eigen::Vector3d& apex) const {
  std::vector<GridCoordinates> feet;
  for (const Eigen::Vector3d& point : loop) {
    const PolarPoint polar = grid_.Polar(point);
    feet.push_back(grid_.Locate(rest_, polar.azimuth, polar.z, grid_.Guess(rest_, polar.azimuth, polar.z)));
  }
  const auto volumes = [&](const Points& grid) {
    const auto point = [&](size_t i, int level) -> Eigen::Vector3d {
      const GridCoordinates& foot = feet[i % feet.size()];
      return grid_.At(grid, {foot.column, foot.row + (grid_.rows() - 1 - foot.row) * level / kLevels}) - apex;
    };
    Eigen::Vector3d top = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < feet.size(); ++i) top += point(i, kLevels) / static_cast<double>(feet.size());
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();  // right, left
    for (size_t i = 0; i < feet.size(); ++i) {
      double strip = 0;
      for (int level = 0; level < kLevels; ++level) {
        const Eigen::Vector3d a = point(i, level), b = point(i + 1, level), c = point(i + 1, level + 1),
                              d = point(i, level + 1);
        strip += ConeOver(a, b, c) + ConeOver(a, c, d);
      }
      strip += ConeOver(point(i, kLevels), point(i + 1, kLevels), top);
      const Eigen::Vector3d& next = loop[(i + 1) % loop.size()];
      sum[loop[i].x() + next.x() < 0 ? 0 : 1] += strip;
    }
    return sum;
  };
  const CageFit fit;
  const Eigen::Vector2d at_rest = volumes(rest_);
  Volumes result;
  for (size_t k = 0; k < moved_.size(); ++k) {
    const Eigen::Vector2d change = volumes(moved_[k]) - at_rest;
    fit.Add(k, change[0], result.right);
    fit.Add(k, change[1], result.left);
  }
  return result;
}

}  // namespace phrenic
