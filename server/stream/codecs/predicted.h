// Residuals of each vertex' displacement from rest after prediction from its neighbours: the viewer's default codec.
#ifndef PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_
#define PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_

#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/codecs/neighbour_predictor.h"

namespace phrenic::stream {

// x = rest + step d, d integers. proto/README.md specifies the bytes. OUT_OF_RANGE for a displacement beyond kFurthest
// steps. The bytes are the step as float64 [m] and the residuals (AppendResiduals).
class PredictedCodec final : public Codec {
 public:
  explicit PredictedCodec(const RestShape& shape);
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  const NeighbourPredictor predictor_;
  const std::vector<float> rest_;  // three per place
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_PREDICTED_H_
