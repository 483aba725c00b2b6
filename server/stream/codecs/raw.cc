#include "server/stream/codecs/raw.h"

#include <cstring>

#include "absl/strings/str_cat.h"
#include "server/stream/codecs/wire.h"

namespace phrenic::stream {

absl::StatusOr<std::string> RawCodec::Encode(const Floats& positions, double /*max_error*/) const {
  std::string bytes;
  AppendFloats(positions, bytes);
  return bytes;
}

absl::StatusOr<Floats> RawCodec::Decode(std::string_view bytes) const {
  Floats positions(3, vertices_);
  const std::size_t size = sizeof(float) * static_cast<std::size_t>(positions.size());
  if (bytes.size() != size) {
    return absl::InvalidArgumentError(
        absl::StrCat("positions: ", bytes.size(), " bytes, but ", vertices_, " vertices have ", size));
  }
  if (size > 0) std::memcpy(positions.data(), bytes.data(), size);
  if (!positions.allFinite()) return absl::InvalidArgumentError("positions: a number is not finite");
  return positions;
}

}  // namespace phrenic::stream
