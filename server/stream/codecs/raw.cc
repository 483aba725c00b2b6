#include "server/stream/codecs/raw.h"

#include "server/stream/codecs/wire.h"
#include "server/stream/decoder/plain_decoders.h"

namespace phrenic::stream {

absl::StatusOr<std::string> RawCodec::Encode(const Floats& positions, double /*max_error*/) const {
  std::string bytes;
  AppendFloats(positions, bytes);
  return bytes;
}

absl::StatusOr<Floats> RawCodec::Decode(std::string_view bytes) const {
  Floats positions(3, vertices_);
  const std::span<float> to(positions.data(), static_cast<std::size_t>(positions.size()));
  if (const char* problem = DecodeRaw(bytes, to)) return absl::InvalidArgumentError(problem);
  return positions;
}

}  // namespace phrenic::stream
