// Integers at the vertices of a mesh, three each, to bytes: raw, or as residuals of the prediction from their
// neighbours. decoder/prediction.h and decoder/residuals.h are the way back.
#ifndef PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
#define PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_

#include <string>
#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/codecs/encoding_kernel.h"
#include "server/stream/decoder/neighbour_weights.h"

namespace phrenic::stream {

// The residual d_i - floor(sum w_j d_j) is small where neighbours are similar. Residuals have two bits each; larger
// ones continue in an overflow that is compressed separately. proto/README.md specifies the bytes. Immutable;
// thread-safe. Its arithmetic is in integers, so that every client gets the same bits.
class NeighbourPredictor {
 public:
  explicit NeighbourPredictor(const RestShape& shape) : neighbours_(MakeNeighbourWeights(MeshOf(shape))) {}

  // Returns the vertex at each place.
  const std::vector<int>& order() const { return neighbours_.order; }
  const NeighbourWeights& weights() const { return neighbours_; }

  // Residuals of integers, modulo 2^32.
  Steps Residuals(const Steps& steps) const;

 private:
  const NeighbourWeights neighbours_;
};

// Appends residuals, given three per place and written all x first. Writes two lengths as little-endian uint32 and two
// zstd frames: two bits per residual, and the overflow as varints.
void AppendResiduals(const Steps& residuals, std::string& bytes);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
