// SIMD kernels of PredictedCodec::Encode and NeighbourPredictor::Residuals. Google Highway compiles them for several
// instruction sets and selects the best at run time; all give the same numbers. Thread-safe.
#ifndef PHRENIC_SERVER_STREAM_CODECS_ENCODING_KERNEL_H_
#define PHRENIC_SERVER_STREAM_CODECS_ENCODING_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/stream/decoder/neighbour_weights.h"

namespace phrenic::stream {

// Displacements from rest in steps of the grid: x y z of each place of NeighbourWeights::order.
using Steps = std::vector<std::int32_t>;

inline constexpr double kFurthest = 1 << 30;  // [steps] that are encoded

// Sets steps[i] = floor((moved[i] - rest[i]) inverse + 1/2); `inverse` is that of the grid's step [1/m]. Returns false
// if one is above kFurthest or not a number. Requires: `moved` and `rest` have as many numbers [m] as `steps`.
bool CountSteps(const std::vector<float>& moved, const std::vector<float>& rest, double inverse, Steps& steps);

// Sets residuals[3 p + axis] = d_p - floor(sum w_j d_j + 1/2) modulo 2^32, d the steps. Requires: as many residuals as
// steps, three for each place.
void SetResiduals(const NeighbourWeights& neighbours, const Steps& steps, Steps& residuals);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_ENCODING_KERNEL_H_
