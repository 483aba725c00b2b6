// Residuals at the vertices of a mesh to integers: each is predicted from earlier vertices (NeighbourWeights).
#ifndef PHRENIC_SERVER_STREAM_DECODER_PREDICTION_H_
#define PHRENIC_SERVER_STREAM_DECODER_PREDICTION_H_

#include <cstdint>
#include <vector>

#include "server/stream/decoder/neighbour_weights.h"

namespace phrenic::stream {

// Four integers per place: x y z and one that is not used, so that a place is one SIMD vector.
using PaddedSteps = std::vector<std::int32_t>;

// d_i = r_i + floor(sum w_j d_j / 4096 + 1/2) modulo 2^32, in the order of places. Immutable; thread-safe.
class Prediction {
 public:
  explicit Prediction(const NeighbourWeights& weights);

  // Replaces residuals by integers, with sums in 32 bits. Returns false if a sum may have overflowed: `steps` are then
  // invalid, and AddExactly gives the integers. Requires here and below: 4 values per place.
  bool AddFast(PaddedSteps& steps) const;
  // The same with sums in 64 bits.
  void AddExactly(PaddedSteps& steps) const;

 private:
  // Neighbours of each place, always kMostNeighbours: what is missing has weight 0.
  struct Neighbour {
    std::int32_t at;  // first value in `steps`
    std::int32_t weight;
  };
  std::vector<Neighbour> neighbours_;
  std::int32_t largest_ = 0;  // magnitude up to which no sum overflows
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_PREDICTION_H_
