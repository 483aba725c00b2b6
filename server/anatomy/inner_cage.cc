#include "server/anatomy/inner_cage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"

namespace phrenic::anatomy {
namespace {

constexpr double kHeight = 396;   // [mm]
constexpr double kQuarter = 144;  // of the circumference [mm]

// How far the meridians go on below and above for a person, and how exactly a height is met [mm].
constexpr double kBelow = 100, kAbove = 4, kExact = 1e-9;
constexpr int kMostRounds = 60;

// Returns the adult's point of the cage at an azimuth and a height.
Eigen::Vector3d OfAdult(double azimuth, double z) {
  const Eigen::Vector2d xy = CageSection(z, kDiaphragmInset).Point({std::sin(azimuth), -std::cos(azimuth)});
  return {xy.x(), xy.y(), z};
}

struct Grid {
  int rows, columns;
  const PhysiqueMap& map;
  double bottom = 0, top = kHeight;  // of a person [mm]
  int Vertex(int i, int j) const { return j * columns + i % columns; }
  // Returns the point of the cage at fractions of columns and rows.
  Eigen::Vector3d At(double i, double j) const {
    const double azimuth = 2 * std::numbers::pi * i / columns;
    if (map.IsIdentity()) return OfAdult(azimuth, kHeight * j / (rows - 1));
    return OfPerson(azimuth, bottom + (top - bottom) * j / (rows - 1));
  }
  // Returns the point at which the meridian of an azimuth, carried by the map, has a height, by regula falsi.
  Eigen::Vector3d OfPerson(double azimuth, double z) const {
    double low = -kBelow, high = kHeight + kAbove;
    const auto above = [&](double at) { return map(OfAdult(azimuth, at)).z() - z; };
    double under = above(low), over = above(high), at = low;
    for (int round = 0, stays = 0; round < kMostRounds && high - low > kExact; ++round) {
      at = low - under * (high - low) / (over - under);
      const double here = above(at);
      if (std::abs(here) < kExact) break;
      const int moved = here < 0 ? -1 : 1;
      (here < 0 ? low : high) = at;
      (here < 0 ? under : over) = here;
      if (stays == moved) (here < 0 ? over : under) /= 2;  // the Illinois rule
      stays = moved;
    }
    Eigen::Vector3d point = map(OfAdult(azimuth, at));
    point.z() = z;
    return point;
  }
};

// Sets the heights between which every meridian of a person exists: the rows are horizontal.
void SetHeights(Grid& grid) {
  grid.bottom = grid.map({0, 0, 0}).z();
  grid.top = std::numeric_limits<double>::infinity();
  for (int i = 0; i < grid.columns; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / grid.columns;
    grid.top = std::min(grid.top, grid.map(OfAdult(azimuth, kHeight)).z());
  }
}

Grid GridFor(double edge_length, const PhysiqueMap& map) {
  const auto parts = [edge_length](double length) { return static_cast<int>(std::lround(length / edge_length)); };
  Grid grid{std::max(2, 1 + parts(kHeight)), 4 * std::max(2, parts(kQuarter)), map};
  if (!map.IsIdentity()) SetHeights(grid);
  return grid;
}

// Returns the point of vertex (i, j), moved outwards by the sag of the chords at it, so that no chord is inside the
// cage. Concave parts are not moved.
Eigen::Vector3d AroundCage(const Grid& grid, int i, int j) {
  constexpr double kMore = 1.02;  // what is between is not quite a parabola
  const Eigen::Vector3d at = grid.At(i, j), left = grid.At(i + 1, j), right = grid.At(i - 1, j);
  const Eigen::Vector3d outwards = (left - right).cross(Eigen::Vector3d::UnitZ()).normalized();
  const auto sag = [&](const Eigen::Vector3d& middle, const Eigen::Vector3d& end) {
    return std::max(0.0, outwards.dot(middle - (at + end) / 2));
  };
  const double across = std::max(sag(grid.At(i + 0.5, j), left), sag(grid.At(i - 0.5, j), right));
  double upwards = 0;
  if (j > 0) upwards = sag(grid.At(i, j - 0.5), grid.At(i, j - 1));
  if (j + 1 < grid.rows) upwards = std::max(upwards, sag(grid.At(i, j + 0.5), grid.At(i, j + 1)));
  return at + kMore * (across + upwards) * outwards;
}

Points Positions(const Grid& grid) {
  Points points(3, grid.rows * grid.columns);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) points.col(grid.Vertex(i, j)) = AroundCage(grid, i, j);
  }
  return points;
}

Triangles Faces(const Grid& grid) {
  Triangles triangles(3, 2 * (grid.rows - 1) * grid.columns);
  Eigen::Index t = 0;
  for (int j = 0; j + 1 < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int a = grid.Vertex(i, j), b = grid.Vertex(i + 1, j);
      const int c = grid.Vertex(i + 1, j + 1), d = grid.Vertex(i, j + 1);
      const bool left = i < grid.columns / 2;
      triangles.col(t++) << a, b, (left ? c : d);
      triangles.col(t++) << (left ? a : b), c, d;
    }
  }
  return triangles;
}

}  // namespace

Mesh InnerCage(double edge_length) { return InnerCage(edge_length, PhysiqueMap({})); }

Mesh InnerCage(double edge_length, const PhysiqueMap& map) {
  const Grid grid = GridFor(edge_length, map);
  Mesh mesh;
  mesh.vertices = Positions(grid);
  mesh.triangles = Faces(grid);
  for (const auto& [name, row] : {std::pair("bottom", 0), std::pair("top", grid.rows - 1)}) {
    std::vector<int>& region = mesh.regions[name];
    region.resize(static_cast<size_t>(grid.columns));
    std::iota(region.begin(), region.end(), grid.Vertex(0, row));
  }
  return mesh;
}

}  // namespace phrenic::anatomy
