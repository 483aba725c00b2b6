#include "server/stream/codecs/predicted.h"

#include "server/stream/codecs/decode.h"
#include "server/stream/codecs/quantise.h"
#include "server/stream/codecs/wire.h"

namespace phrenic::stream {
namespace {

Floats InOrder(const Floats& values, const std::vector<int>& order) {
  Floats ordered(3, values.cols());
  for (std::size_t i = 0; i < order.size(); ++i) ordered.col(static_cast<Eigen::Index>(i)) = values.col(order[i]);
  return ordered;
}

}  // namespace

PredictedCodec::PredictedCodec(const RestShape& shape)
    : predictor_(shape), rest_(InOrder(shape.rest, predictor_.order())) {}

absl::StatusOr<std::string> PredictedCodec::Encode(const Floats& positions, double max_error) const {
  const auto step = GridStep(positions, max_error);
  if (!step.has_value() || !IsGridStep(*step)) return absl::OutOfRangeError("the bound is finer than float32");
  Steps displacements(static_cast<std::size_t>(rest_.size()));
  const double inverse = 1 / *step;
  for (int place = 0; place < static_cast<int>(rest_.cols()); ++place) {
    const int vertex = predictor_.order()[place];
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = static_cast<double>(positions(axis, vertex)) - static_cast<double>(rest_(axis, place));
      const double steps = std::floor(moved * inverse + 0.5);
      if (!(std::abs(steps) <= kFurthest)) return absl::OutOfRangeError("a vertex is too far from rest");
      displacements[3 * place + axis] = static_cast<std::int32_t>(steps);
    }
  }
  std::string bytes;
  Append(*step, bytes);
  AppendResiduals(predictor_.Residuals(displacements), bytes);
  return bytes;
}

absl::StatusOr<Floats> PredictedCodec::Decode(std::string_view bytes) const {
  Floats rest(3, rest_.cols());
  for (int place = 0; place < static_cast<int>(rest_.cols()); ++place) {
    rest.col(predictor_.order()[place]) = rest_.col(place);
  }
  PositionDecoder decoder({rest.data(), static_cast<std::size_t>(rest.size())}, predictor_.weights());
  return DecodeBy(decoder, v1::CODEC_PREDICTED, bytes);
}

}  // namespace phrenic::stream
