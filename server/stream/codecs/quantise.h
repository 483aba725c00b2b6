// Quantisation of positions to a grid within an error bound.
#ifndef PHRENIC_SERVER_STREAM_CODECS_QUANTISE_H_
#define PHRENIC_SERVER_STREAM_CODECS_QUANTISE_H_

#include <cmath>
#include <optional>

#include "server/stream/codecs/codec.h"
#include "server/stream/decoder/grid_step.h"

namespace phrenic::stream {

// Errors of codecs that cannot meet a bound. The encoder of frames then takes CODEC_RAW.
inline constexpr char kTooFine[] =
    "max_error_mm: it is finer than float32 numbers of these positions; take a larger one, or CODEC_RAW";
inline constexpr char kTooFar[] =
    "positions: a vertex is more steps of max_error_mm away than the codec can write; take a larger max_error_mm, or "
    "CODEC_RAW";

// Returns the grid step [m] for which rounding each coordinate moves no vertex by more than `max_error` [m]:
// sqrt(3)/2 step plus the rounding of the result to float32. Nothing if float32 alone takes half of the bound or more.
inline std::optional<double> GridStep(const Floats& positions, double max_error) {
  const double largest = positions.size() == 0 ? 0 : positions.cwiseAbs().maxCoeff();
  const double rounding = std::ldexp(largest + max_error, -23);  // above sqrt(3) half units in the last place
  if (!(rounding <= max_error / 2)) return std::nullopt;
  return 2 / std::sqrt(3.0) * (max_error - rounding);
}

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_QUANTISE_H_
