// Bounds of the coordinates of positions and velocities, by which a step is checked for divergence.
#ifndef PHRENIC_SERVER_MECHANICS_LINALG_STATE_BOUNDS_H_
#define PHRENIC_SERVER_MECHANICS_LINALG_STATE_BOUNDS_H_

#include <cmath>

namespace phrenic {

// The largest magnitude of any coordinate of some vertices' positions and velocities, or an upper bound of it. NaN if
// any coordinate is NaN.
struct StateBounds {
  double furthest = 0, fastest = 0;  // [m], [m/s]
};

// Returns the larger of two magnitudes. NaN if either is NaN.
inline double LargerMagnitude(double a, double b) { return a > b || std::isnan(a) ? a : b; }

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LINALG_STATE_BOUNDS_H_
