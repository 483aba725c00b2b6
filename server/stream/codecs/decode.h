// The decoder of viewers for rest shapes and positions of Eigen.
#ifndef PHRENIC_SERVER_STREAM_CODECS_DECODE_H_
#define PHRENIC_SERVER_STREAM_CODECS_DECODE_H_

#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/decoder/position_decoder.h"

namespace phrenic::stream {

// Returns the shapes one after the other, as PositionDecoder::SetBasis takes them.
inline std::vector<float> JoinShapes(const std::vector<Floats>& shapes) {
  std::vector<float> joined;
  for (const Floats& shape : shapes) joined.insert(joined.end(), shape.data(), shape.data() + shape.size());
  return joined;
}

// Returns a decoder of all codecs.
inline std::unique_ptr<PositionDecoder> MakeDecoder(const RestShape& shape) {
  auto decoder = std::make_unique<PositionDecoder>(MeshOf(shape));
  decoder->SetBasis(JoinShapes(shape.shapes), shape.shapes.size());
  return decoder;
}

// Returns the positions, or INVALID_ARGUMENT with what is wrong with the bytes.
inline absl::StatusOr<Floats> DecodeBy(PositionDecoder& decoder, v1::Codec codec, std::string_view bytes) {
  Floats positions(3, static_cast<Eigen::Index>(decoder.vertices()));
  const std::span<float> to(positions.data(), static_cast<std::size_t>(positions.size()));
  if (const char* problem = decoder.Decode(codec, bytes, to)) return absl::InvalidArgumentError(problem);
  return positions;
}

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_DECODE_H_
