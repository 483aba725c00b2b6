// Integers at the vertices of a mesh, three each, to bytes and back: raw, or as residuals of the prediction from their
// neighbours.
#ifndef PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
#define PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/codecs/neighbour_weights.h"

namespace phrenic::stream {

// Three per place of NeighbourWeights::order.
using Steps = std::vector<std::int32_t>;

inline constexpr double kFurthest = 1 << 30;  // [steps] that are encoded

// The residual d_i - floor(sum w_j d_j) is small where neighbours are similar. Residuals have two bits each; larger
// ones continue in an overflow that is compressed separately. proto/README.md specifies the bytes. Immutable;
// thread-safe. Its arithmetic is in integers, so that every client gets the same bits.
class NeighbourPredictor {
 public:
  explicit NeighbourPredictor(const RestShape& shape) : neighbours_(MakeNeighbourWeights(shape)) {}

  // Returns the vertex at each place.
  const std::vector<int>& order() const { return neighbours_.order; }

  // Residuals of integers, and integers of residuals, modulo 2^32.
  Steps Residuals(const Steps& steps) const;
  Steps Sums(const Steps& residuals) const;

 private:
  // Returns floor(sum w_j d_j + 1/2) at a place, from the steps of earlier places.
  std::array<std::int64_t, 3> Predict(const Steps& steps, int place) const;

  const NeighbourWeights neighbours_;
};

// Appends residuals, given three per place and written all x first. Writes two lengths as little-endian uint32 and two
// zstd frames: two bits per residual, and the overflow as varints.
void AppendResiduals(const Steps& residuals, std::string& bytes);
// INVALID_ARGUMENT for bytes that do not encode residuals of that many places. Allocates no more than `places` require.
absl::StatusOr<Steps> ReadResiduals(std::string_view bytes, std::size_t places);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
