// A polar grid of points around a vertical axis, such as the inner surface of a rib cage, and coordinates on it.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_WALL_GRID_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_WALL_GRID_H_

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Where a point lies on a grid: fractions of columns (around) and of rows (upwards).
struct GridCoordinates {
  double column = 0, row = 0;
};

// Where a point lies around the axis.
struct PolarPoint {
  double azimuth = 0;        // [rad] from the front (-y) towards +x, in [0, 2 pi)
  double z = 0, radius = 0;  // [m]
};

// The layout of a grid: vertices row by row from below, each row once around from the front towards +x. Immutable.
class WallGrid {
 public:
  // Finds the columns, rows and axis of a grid at rest, whose rows are horizontal. The axis lies at x = 0 between front
  // and back, where the most rows from below go around it without turning back. INVALID_ARGUMENT if the points are no
  // such grid.
  static absl::StatusOr<WallGrid> Find(const Points& rest);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double axis_y() const { return axis_y_; }  // [m]
  // Rows from below that each azimuth meets once: only in those do Locate and Polar agree.
  int star_rows() const { return star_rows_; }
  PolarPoint Polar(const Eigen::Vector3d& point) const;
  // Returns the point of a grid at fractions of columns, which wrap around, and of rows, which are clamped.
  Eigen::Vector3d At(const Points& grid, const GridCoordinates& at) const;
  // Returns the coordinates at which a grid has an azimuth and a height, by Newton's method from `guess`.
  GridCoordinates Locate(const Points& grid, double azimuth, double z, const GridCoordinates& guess) const;
  // Returns a guess for Locate, from the grid at rest being nearly regular.
  GridCoordinates Guess(const Points& rest, double azimuth, double z) const;

 private:
  int StarRows(const Points& rest) const;
  double Azimuth(const Eigen::Vector3d& point) const;  // of Polar

  int columns_ = 0, rows_ = 0, star_rows_ = 0;
  double axis_y_ = 0;  // [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_WALL_GRID_H_
