// Positions on a grid whose step keeps an error bound.
#ifndef PHRENIC_SERVER_STREAM_QUANTISE_H_
#define PHRENIC_SERVER_STREAM_QUANTISE_H_

#include <cmath>
#include <optional>

#include "server/stream/codec.h"

namespace phrenic::stream {

// The step [m] at which rounding each coordinate to the nearest multiple moves no vertex by more than `max_error` [m]:
// sqrt(3)/2 step, and what float32 rounds off the result. None where float32 alone takes half of the bound or more.
inline std::optional<double> GridStep(const Floats& positions, double max_error) {
  const double largest = positions.size() == 0 ? 0 : positions.cwiseAbs().maxCoeff();
  const double rounding = std::ldexp(largest + max_error, -23);  // above sqrt(3) half units in the last place
  if (!(rounding <= max_error / 2)) return std::nullopt;
  return 2 / std::sqrt(3.0) * (max_error - rounding);
}

inline constexpr double kLargestStep = 1;  // [m]: a step that is decoded is above 0 and not above this

// Nothing that is decoded gets further than 2^31 steps from rest, so that every float32 is finite.
inline bool IsGridStep(double step) { return step > 0 && step <= kLargestStep; }

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_QUANTISE_H_
