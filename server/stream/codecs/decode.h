// Codec::Decode by the decoder of viewers.
#ifndef PHRENIC_SERVER_STREAM_CODECS_DECODE_H_
#define PHRENIC_SERVER_STREAM_CODECS_DECODE_H_

#include <string_view>

#include "server/stream/codecs/codec.h"
#include "server/stream/decoder/position_decoder.h"

namespace phrenic::stream {

// Returns the positions, or INVALID_ARGUMENT with what is wrong with the bytes.
inline absl::StatusOr<Floats> DecodeBy(PositionDecoder& decoder, v1::Codec codec, std::string_view bytes) {
  Floats positions(3, static_cast<Eigen::Index>(decoder.vertices()));
  const std::span<float> to(positions.data(), static_cast<std::size_t>(positions.size()));
  if (const char* problem = decoder.Decode(codec, bytes, to)) return absl::InvalidArgumentError(problem);
  return positions;
}

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_DECODE_H_
