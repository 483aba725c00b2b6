// Whole numbers at the vertices of a mesh, three each, to bytes and back: as they are, or what is left of them after
// they are foretold from their neighbours'.
#ifndef PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
#define PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "server/stream/codec.h"
#include "server/stream/neighbour_weights.h"

namespace phrenic::stream {

// Three a place: places are in the order of the neighbour weights.
using Steps = std::vector<std::int32_t>;

inline constexpr double kFurthest = 1 << 30;  // [steps] that are encoded

// d_i - round(sum w_j d_j) is small where neighbours are alike. Two bits each and the larger ones' rest are compressed
// apart; proto/README.md has the bytes. Immutable; any thread may call.
class NeighbourPredictor {
 public:
  explicit NeighbourPredictor(const RestShape& shape) : neighbours_(MakeNeighbourWeights(shape)) {}

  // The vertex at each place.
  const std::vector<int>& order() const { return neighbours_.order; }

  // Modulo 2^32.
  Steps Remainders(const Steps& steps) const;
  Steps Sums(const Steps& remainders) const;

 private:
  std::array<std::int64_t, 3> Foretell(const Steps& steps, int place) const;

  const NeighbourWeights neighbours_;
};

// Appends the remainders of `places` vertices, given three a place and written all x first.
void AppendRemainders(const Steps& remainders, std::string& bytes);
// INVALID_ARGUMENT for bytes that are no such remainders.
absl::StatusOr<Steps> ReadRemainders(std::string_view bytes, std::size_t places);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_NEIGHBOUR_PREDICTOR_H_
