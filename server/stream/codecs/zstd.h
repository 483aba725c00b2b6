// Zstandard compression (RFC 8878): one frame per string.
#ifndef PHRENIC_SERVER_STREAM_CODECS_ZSTD_H_
#define PHRENIC_SERVER_STREAM_CODECS_ZSTD_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::stream {

// Appends a frame of the fastest level to `compressed` and returns its number of bytes. Thread-safe. Each thread keeps
// one context of about 0.5 MB.
std::size_t AppendCompressed(std::string_view bytes, std::string& compressed);

// Returns a frame that is small and takes about 0.5 s per megabyte, for files. Thread-safe. Needs up to 90 MB
// meanwhile.
std::string CompressSmall(std::string_view bytes);

// INVALID_ARGUMENT unless `compressed` decompresses to exactly `size` bytes; allocates no more than that. Thread-safe.
absl::StatusOr<std::string> Decompress(std::string_view compressed, std::size_t size);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_ZSTD_H_
