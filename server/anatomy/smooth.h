// A soft step, by which one thickness or angle passes into another.
#ifndef PHRENIC_SERVER_ANATOMY_SMOOTH_H_
#define PHRENIC_SERVER_ANATOMY_SMOOTH_H_

#include <algorithm>

namespace phrenic::anatomy {

// 0 up to t = 0, 1 from t = 1, level at both.
inline double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SMOOTH_H_
