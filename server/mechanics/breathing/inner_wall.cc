#include "server/mechanics/breathing/inner_wall.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/mechanics/parallel/compile_threads.h"

namespace phrenic {
namespace {

constexpr int kTurns = kWallTurns, kHeights = kWallHeights;
constexpr double kQuarter = kWallQuarter, kLeastRadius = kLeastWallRadius;
constexpr double kStill = 3e-4;   // where the whole cage moves by less no part has weight [m]
constexpr size_t kWholeCage = 4;  // of CageFit::Positions(): both coordinates where a part departs to
constexpr int kLevels = 60;       // of the wall between a loop and its top

// A measure of the azimuth, in [0, 4), and its derivatives by x and y.
struct WallTurn {
  double value, by_x, by_y;
};

WallTurn WallTurnOf(double x, double front) {
  const double size = std::max(std::abs(x) + std::abs(front), kLeastRadius), ratio = x / size;
  const double value = front < 0 ? 2 - ratio : (x < 0 ? 4 + ratio : ratio);
  return {value < 4 ? value : 0, front / (size * size), x / (size * size)};
}

double AzimuthOfTurn(double turn) {
  const double ratio = turn < 1 ? turn : (turn < 3 ? 2 - turn : turn - 4);
  const double front = (turn < 1 || turn > 3 ? 1 : -1) * (1 - std::abs(ratio));
  const double azimuth = std::atan2(ratio, front);
  return azimuth < 0 ? azimuth + 2 * std::numbers::pi : azimuth;
}

// A row of the table; the lowest one for what is no number.
double WithinRows(double row) { return std::fmin(std::fmax(row, 0.0), kHeights - 1.0); }

// The four entries around a point of the table, and where it lies between them.
struct WallCell {
  int low_left, low_right, high_left, high_right;
  double u, v;  // fractions to the right and upwards
  bool inside;  // not beyond the table's lower or upper border

  double Mean(const std::vector<double>& of) const {
    return (1 - v) * ((1 - u) * of[low_left] + u * of[low_right]) + v * ((1 - u) * of[high_left] + u * of[high_right]);
  }
};

WallCell WallCellAt(double turn, double height) {
  const double column = turn * kQuarter, row = WithinRows(height * (kHeights - 1));
  const int left = static_cast<int>(std::fmin(std::fmax(column, 0.0), kTurns - 1.0)),
            below = std::min(static_cast<int>(row), kHeights - 2);
  const int right = left + 1 < kTurns ? left + 1 : 0, low = below * kTurns, high = low + kTurns;
  return {low + left, low + right, high + left, high + right, column - left, row - below, height > 0 && height < 1};
}

double ConeOver(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return a.dot(b.cross(c)) / 6;
}

}  // namespace

absl::StatusOr<InnerWall> InnerWall::Make(const Points& rest, const std::vector<Points>& moved,
                                          const AllPartGrids& parts) {
  const auto grid = WallGrid::Find(rest);
  if (!grid.ok()) return grid.status();
  InnerWall wall(*grid);
  wall.rest_ = rest;
  wall.moved_ = moved;
  wall.parts_ = parts;
  wall.bottom_ = rest(2, 0);
  wall.height_ = rest(2, grid->columns() * (grid->star_rows() - 1)) - wall.bottom_;
  wall.WeighParts();
  wall.Tabulate();
  return wall;
}

// The part's displacement along that of the whole cage, where that is not small.
void InnerWall::WeighParts() {
  for (size_t part = 0; part < kCageParts; ++part) {
    if (parts_[part].departed.empty()) continue;
    const Points by_part = (parts_[part].departed[1] - parts_[part].departed[0]) / 2;
    const Points whole = moved_[kWholeCage] - rest_;
    weight_[part] = Points::Zero(3, rest_.cols());
    for (Eigen::Index i = 0; i < rest_.cols(); ++i) {
      const double still = kStill * kStill;
      weight_[part](0, i) = by_part.col(i).dot(whole.col(i)) / (whole.col(i).squaredNorm() + still);
    }
  }
}

void InnerWall::Tabulate() {
  const CageFit fit;
  shape_.radius.resize(kTurns * kHeights);
  for (auto& coefficient : shape_.change) coefficient.resize(shape_.radius.size());
  for (size_t part = 0; part < kCageParts; ++part) {
    shape_.weight[part].resize(weight_[part].size() > 0 ? shape_.radius.size() : 0);
  }
  const auto tabulate = [&](int row, int turn) {
    const int entry = row * kTurns + turn;
    const double azimuth = AzimuthOfTurn(turn / kQuarter);
    const double z = bottom_ + height_ * row / (kHeights - 1);
    const GridCoordinates there = grid_.Locate(rest_, azimuth, z, grid_.Guess(rest_, azimuth, z));
    shape_.radius[entry] = grid_.Polar(grid_.At(rest_, there)).radius;
    CageQuadratic change;
    for (size_t k = 0; k < moved_.size(); ++k) {
      const GridCoordinates now = grid_.Locate(moved_[k], azimuth, z, there);
      fit.Add(k, grid_.Polar(grid_.At(moved_[k], now)).radius - shape_.radius[entry], change);
    }
    for (size_t j = 0; j < change.c.size(); ++j) shape_.change[j][entry] = change.c[j];
    for (size_t part = 0; part < kCageParts; ++part) {
      if (weight_[part].size() > 0) shape_.weight[part][entry] = grid_.At(weight_[part], there).x();
    }
  };
  ForEachPart(kHeights, [&](std::int64_t row) {
    for (int turn = 0; turn < kTurns; ++turn) tabulate(static_cast<int>(row), turn);
  });
}

bool InnerWall::IsFarInside(const WallTable& table, const Eigen::Vector3d& point, double margin) const {
  const double row = WithinRows((point.z() - bottom_) / height_ * (kHeights - 1));
  const int below = std::min(static_cast<int>(row), kHeights - 2);
  const double bound = table.least[below] - margin;
  const double front = grid_.axis_y() - point.y();
  return bound > 0 && point.x() * point.x() + front * front < bound * bound;
}

WallGap InnerWall::Gap(const WallTable& table, const Eigen::Vector3d& point) const {
  const double x = point.x(), front = grid_.axis_y() - point.y();
  const WallTurn turn = WallTurnOf(x, front);
  const WallCell cell = WallCellAt(turn.value, (point.z() - bottom_) / height_);
  const double u = cell.u, v = cell.v;
  const std::vector<double>& r = table.radius;
  const double low = r[cell.low_right] - r[cell.low_left], high = r[cell.high_right] - r[cell.high_left];
  const double left = r[cell.high_left] - r[cell.low_left], right = r[cell.high_right] - r[cell.low_right];
  const double by_turn = ((1 - v) * low + v * high) * kQuarter;
  const double by_z = cell.inside ? ((1 - u) * left + u * right) * (kHeights - 1) / height_ : 0;
  const double radius = std::max(std::sqrt(x * x + front * front), kLeastRadius);
  return {.gap = radius - cell.Mean(r),
          .gradient = {x / radius - by_turn * turn.by_x, -front / radius - by_turn * turn.by_y, -by_z},
          .by_pump = -cell.Mean(table.by_pump),
          .by_bucket = -cell.Mean(table.by_bucket)};
}

double InnerWall::GapAlone(const WallTable& table, const Eigen::Vector3d& point) const {
  const double x = point.x(), front = grid_.axis_y() - point.y();
  const WallCell cell = WallCellAt(WallTurnOf(x, front).value, (point.z() - bottom_) / height_);
  return std::max(std::sqrt(x * x + front * front), kLeastRadius) - cell.Mean(table.radius);
}

InnerWall::Follower InnerWall::Follow(const Eigen::Vector3d& point) const {
  const PolarPoint polar = grid_.Polar(point);
  const GridCoordinates there = grid_.Locate(rest_, polar.azimuth, polar.z, grid_.Guess(rest_, polar.azimuth, polar.z));
  const Eigen::Vector3d from = grid_.At(rest_, there);
  const CageFit fit;
  Follower follower;
  for (size_t k = 0; k < moved_.size(); ++k) {
    const Eigen::Vector3d shift = grid_.At(moved_[k], there) - from;
    for (int axis = 0; axis < 3; ++axis) fit.Add(k, shift[axis], follower.shift[axis]);
  }
  for (size_t part = 0; part < kCageParts; ++part) {
    if (weight_[part].size() > 0) follower.weight[part] = grid_.At(weight_[part], there).x();
  }
  return follower;
}

Eigen::Vector2d InnerWall::VolumeOf(const Points& grid, const std::vector<GridCoordinates>& feet,
                                    const std::vector<Eigen::Vector3d>& loop, const Eigen::Vector3d& apex) const {
  const auto point = [&](size_t i, int level) -> Eigen::Vector3d {
    const GridCoordinates& foot = feet[i % feet.size()];
    return grid_.At(grid, {foot.column, foot.row + (grid_.rows() - 1 - foot.row) * level / kLevels}) - apex;
  };
  Eigen::Vector3d top = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < feet.size(); ++i) top += point(i, kLevels) / static_cast<double>(feet.size());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
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
}

InnerWall::Volumes InnerWall::VolumesAbove(const std::vector<Eigen::Vector3d>& loop,
                                           const Eigen::Vector3d& apex) const {
  std::vector<GridCoordinates> feet;
  for (const Eigen::Vector3d& point : loop) {
    const PolarPoint polar = grid_.Polar(point);
    feet.push_back(grid_.Locate(rest_, polar.azimuth, polar.z, grid_.Guess(rest_, polar.azimuth, polar.z)));
  }
  // The volumes of every grid, then their changes.
  std::vector<const Points*> grids = {&rest_};
  for (const Points& moved : moved_) grids.push_back(&moved);
  for (const PartGrids& part : parts_) {
    for (size_t i = 0; i < part.departed.size(); ++i) {
      grids.push_back(&part.departed[i]);
      grids.push_back(&part.shared[i]);
    }
  }
  std::vector<Eigen::Vector2d> volumes(grids.size());
  ForEachPart(std::ssize(grids), [&](std::int64_t g) { volumes[g] = VolumeOf(*grids[g], feet, loop, apex); });
  const CageFit fit;
  Volumes result;
  for (size_t k = 0; k < moved_.size(); ++k) {
    const Eigen::Vector2d change = volumes[1 + k] - volumes[0];
    fit.Add(k, change[0], result.right.shared);
    fit.Add(k, change[1], result.left.shared);
  }
  size_t next = 1 + moved_.size();
  for (size_t part = 0; part < kCageParts; ++part) {
    std::array<double, 4> right = {}, left = {};
    for (size_t i = 0; i < parts_[part].departed.size(); ++i, next += 2) {
      const Eigen::Vector2d change = volumes[next] - volumes[next + 1];
      right[i] = change[0], left[i] = change[1];
    }
    result.right.parts[part] = CageFit::Through(right);
    result.left.parts[part] = CageFit::Through(left);
  }
  return result;
}

}  // namespace phrenic
