// SIMD kernel of the contact with the inner wall of the cage (inner_wall.h, wall_contact.h), eight vertices at a time.
// Google Highway compiles it for several instruction sets and selects the best one at run time. The results are bitwise
// equal on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_WALL_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_WALL_KERNEL_H_

#include <array>
#include <cstdint>
#include <vector>

#include "server/mechanics/breathing/cage_quadratic.h"

namespace phrenic {

inline constexpr int kWallTurns = 96, kWallHeights = 48;  // of the table; the turns are a multiple of eight
inline constexpr double kWallQuarter = kWallTurns / 4.0;  // entries of a quarter turn
inline constexpr double kLeastWallRadius = 1e-6;          // closer to the axis a point has no turn [m]

// Where the table of a wall lies.
struct WallFrame {
  double axis_y = 0, bottom = 0, height = 0;  // [m]
};

// The wall for one position of the cage: the radius at the table's entries, which bilinear interpolation reads, and its
// derivatives, row after row [m].
struct WallTable {
  std::vector<double> radius, by_pump, by_bucket;
  std::array<std::vector<double>, kCageParts> by_part;  // empty for parts that do not move
  std::vector<double> least;                            // radius of each row and the next
  std::vector<double> departure;                        // of each entry from the shared coordinates, while parts depart
};

// What the radius depends on, one value per entry of the table: the radius at rest, the coefficients of its quadratic
// in the coordinates of the place, and the weights of the cage's parts; empty for a part that the cage lacks.
struct WallShape {
  std::vector<double> radius;  // [m]
  std::array<std::vector<double>, 5> change;
  std::array<std::vector<double>, kCageParts> weight;
};

// The parts of a cage that forces move now.
using MovingParts = std::array<bool, kCageParts>;

// Sets `table`, with derivatives by the parts that move. A cage whose parts do not move and are at 0 costs nothing more
// than one without parts.
void EvaluateWall(const WallShape& shape, const CagePosition& k, const MovingParts& moving, WallTable& table);

// Eight vertices that may touch the wall. Padding repeats the first vertex and is not counted.
struct SliderPacket {
  std::int32_t offset[8];  // in x [doubles]
  double stiffness[8];     // times the vertex' area [N/m]
  double touching[8];      // gap from which the wall pushes [m]
  std::int32_t count;      // that are no padding
};

// The generalised forces of the contact on the cage.
struct WallReaction {
  double pump = 0, bucket = 0;                // [J]
  std::array<double, kCageParts> parts = {};  // [J]
};

// Adds to f, with the layout of x, the forces -k min(g - g_0, `largest_depth`) grad g of the vertices beyond their
// touching gap g_0. Vertices that are deeper inside than `margin` [m] touch nothing. Thread-safe.
WallReaction PushFromWall(const std::vector<SliderPacket>& packets, const WallFrame& frame, const WallTable& table,
                          double margin, double largest_depth, const double* x, double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_WALL_KERNEL_H_
