// Zstandard (RFC 8878), as quick as it gets: one frame a string.
#ifndef PHRENIC_SERVER_STREAM_ZSTD_H_
#define PHRENIC_SERVER_STREAM_ZSTD_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::stream {

// Appends a frame to `compressed` and returns its number of bytes. Any thread may call.
std::size_t AppendCompressed(std::string_view bytes, std::string& compressed);

// INVALID_ARGUMENT unless `compressed` is a frame of exactly `size` bytes; never allocates more.
absl::StatusOr<std::string> Decompress(std::string_view compressed, std::size_t size);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_ZSTD_H_
