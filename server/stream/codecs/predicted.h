// What is left of each vertex' displacement from rest after it is foretold from its neighbours': the viewer's codec.
#ifndef PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_
#define PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_

#include <array>
#include <cstdint>
#include <vector>

#include "server/stream/codec.h"
#include "server/stream/neighbour_weights.h"

namespace phrenic::stream {

// x = rest + step d; d_i - round(sum w_j d_j) is small where neighbours move alike. Two bits each and the larger ones'
// rest are compressed apart; proto/README.md has the bytes. Neighbours and weights: neighbour_weights.h.
class PredictedCodec final : public Codec {
 public:
  explicit PredictedCodec(const RestShape& shape);
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  // Three a place.
  using Displacements = std::vector<std::int32_t>;

  // Of the vertex at `place`, in steps.
  std::array<std::int64_t, 3> Foretell(const Displacements& displacements, int place) const;

  const NeighbourWeights neighbours_;
  Floats rest_;  // in the order of places
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_
