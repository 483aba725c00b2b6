// Smoothstep, which blends one thickness or angle into another.
#ifndef PHRENIC_SERVER_ANATOMY_MESHING_SMOOTH_H_
#define PHRENIC_SERVER_ANATOMY_MESHING_SMOOTH_H_

#include <algorithm>

namespace phrenic::anatomy {

// Returns t^2 (3 - 2 t) for t clamped to [0, 1]: C1, with zero slope at both ends.
inline double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_MESHING_SMOOTH_H_
