#include "server/stream/codecs/predicted.h"

#include <algorithm>

#include "server/stream/codecs/decode.h"
#include "server/stream/codecs/quantise.h"
#include "server/stream/codecs/wire.h"

namespace phrenic::stream {
namespace {

// Returns three numbers per place.
std::vector<float> InOrder(const Floats& values, const std::vector<int>& order) {
  std::vector<float> ordered(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(values.col(order[i]).data(), 3, &ordered[3 * i]);
  return ordered;
}

}  // namespace

PredictedCodec::PredictedCodec(const RestShape& shape)
    : predictor_(shape), rest_(InOrder(shape.rest, predictor_.order())) {}

absl::StatusOr<std::string> PredictedCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value() || !IsGridStep(*step)) return absl::OutOfRangeError(kTooFine);
  Steps displacements(rest_.size());
  if (!CountSteps(InOrder(positions, predictor_.order()), rest_, 1 / *step, displacements)) {
    return absl::OutOfRangeError(kTooFar);
  }
  std::string bytes;
  Append(*step, bytes);
  AppendResiduals(predictor_.Residuals(displacements), bytes);
  return bytes;
}

absl::StatusOr<Floats> PredictedCodec::Decode(std::string_view bytes) const {
  const std::vector<int>& order = predictor_.order();
  std::vector<float> rest(rest_.size());
  for (std::size_t place = 0; place < order.size(); ++place) {
    std::copy_n(&rest_[3 * place], 3, &rest[3 * static_cast<std::size_t>(order[place])]);
  }
  PositionDecoder decoder(rest, predictor_.weights());
  return DecodeBy(decoder, v1::CODEC_PREDICTED, bytes);
}

}  // namespace phrenic::stream
