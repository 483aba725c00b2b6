#include "server/mechanics/breathing/wall_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"

namespace phrenic {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSameHeight = 1e-6;  // [m]
constexpr int kAxisTries = 20;        // places of the axis that are tried
constexpr int kLocateSteps = 25;
constexpr double kLocated = 1e-7;   // of a column and a row
constexpr double kMostColumns = 3;  // of columns in a step of Newton's method

double Wrapped(double angle) { return angle - kTurn * std::floor((angle + std::numbers::pi) / kTurn); }

absl::Status NoGrid(std::string_view why) {
  return absl::InvalidArgumentError(
      absl::StrCat("is no polar grid (STRUCTURE_INNER_CAGE): ", std::string(why),
                   "; vertices go row by row upwards, each row once around from the front towards +x"));
}

int LeadingAtOneHeight(const Points& rest) {
  int count = 0;
  while (count < rest.cols() && std::abs(rest(2, count) - rest(2, 0)) < kSameHeight) ++count;
  return count;
}

}  // namespace

absl::StatusOr<WallGrid> WallGrid::Find(const Points& rest) {
  WallGrid grid;
  grid.columns_ = LeadingAtOneHeight(rest);
  if (grid.columns_ < 8 || rest.cols() % grid.columns_ != 0) return NoGrid("its rows differ in length");
  grid.rows_ = static_cast<int>(rest.cols()) / grid.columns_;
  if (grid.rows_ < 2) return NoGrid("it has one row");
  for (int i = 0; i < rest.cols(); ++i) {
    const int next = i / grid.columns_ * grid.columns_ + (i + 1) % grid.columns_;
    if (std::abs(rest(2, i) - rest(2, next)) > kSameHeight) return NoGrid("a row is not horizontal");
  }
  const int middle = grid.rows_ / 2 * grid.columns_;
  const double front = rest(1, middle), back = rest(1, middle + grid.columns_ / 2);
  WallGrid best = grid;
  for (int i = 1; i < kAxisTries; ++i) {
    grid.axis_y_ = front + (back - front) * i / kAxisTries;
    grid.star_rows_ = grid.StarRows(rest);
    if (grid.star_rows_ > best.star_rows_) best = grid;
  }
  if (best.star_rows_ < 2) return NoGrid("its rows turn back around the vertical axis");
  return best;
}

int WallGrid::StarRows(const Points& rest) const {
  for (int i = 0; i < rest.cols(); ++i) {
    const int next = i / columns_ * columns_ + (i + 1) % columns_;
    if (!(Wrapped(Azimuth(rest.col(next)) - Azimuth(rest.col(i))) > 0)) return i / columns_;
  }
  return rows_;
}

double WallGrid::Azimuth(const Eigen::Vector3d& point) const {
  const double azimuth = std::atan2(point.x(), -(point.y() - axis_y_));
  return azimuth < 0 ? azimuth + kTurn : azimuth;
}

PolarPoint WallGrid::Polar(const Eigen::Vector3d& point) const {
  return {Azimuth(point), point.z(), std::hypot(point.x(), point.y() - axis_y_)};
}

Eigen::Vector3d WallGrid::At(const Points& grid, const GridCoordinates& at) const {
  const double column = at.column - columns_ * std::floor(at.column / columns_);
  const double row = std::clamp(at.row, 0.0, rows_ - 1.0);
  const int left = std::min(static_cast<int>(column), columns_ - 1), right = (left + 1) % columns_;
  const int below = std::min(static_cast<int>(row), rows_ - 2);
  const double u = column - left, v = row - below;
  const double w = 1 - u;
  const int low = below * columns_, high = low + columns_;
  return (1 - v) * (w * grid.col(low + left) + u * grid.col(low + right)) +
         v * (w * grid.col(high + left) + u * grid.col(high + right));
}

GridCoordinates WallGrid::Guess(const Points& rest, double azimuth, double z) const {
  const double bottom = rest(2, 0), top = rest(2, rest.cols() - 1);
  return {azimuth / kTurn * columns_, std::clamp((z - bottom) / (top - bottom), 0.0, 1.0) * (rows_ - 1)};
}

GridCoordinates WallGrid::Locate(const Points& grid, double azimuth, double z, const GridCoordinates& guess) const {
  GridCoordinates at = guess;
  for (int step = 0; step < kLocateSteps; ++step) {
    const Eigen::Vector3d here = At(grid, at);
    const double left = Azimuth(At(grid, {at.column - 0.5, at.row}));
    const double right = Azimuth(At(grid, {at.column + 0.5, at.row}));
    const double around = std::max(Wrapped(right - left), 0.1 * kTurn / columns_);
    const double low = std::clamp(at.row - 0.5, 0.0, rows_ - 2.0);
    const double up = At(grid, {at.column, low + 1}).z() - At(grid, {at.column, low}).z();
    const double columns = std::clamp(Wrapped(azimuth - Azimuth(here)) / around, -kMostColumns, kMostColumns);
    const double row = std::clamp(at.row + (up > 0 ? (z - here.z()) / up : 0), 0.0, rows_ - 1.0);
    const bool done = std::abs(columns) < kLocated && std::abs(row - at.row) < kLocated;
    at = {at.column + columns, row};
    if (done) break;
  }
  return at;
}

}  // namespace phrenic
