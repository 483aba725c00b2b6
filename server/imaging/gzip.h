// gzip compression (RFC 1952), and reading of raw deflate data (RFC 1951), by zlib. Thread-safe.
#ifndef PHRENIC_SERVER_IMAGING_GZIP_H_
#define PHRENIC_SERVER_IMAGING_GZIP_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::imaging {

// True if the data starts with gzip's magic number.
bool IsGzip(std::string_view bytes);

// Returns up to `max_bytes` of the uncompressed data and allocates no more. Verifies the checksum if it reaches the
// end. INVALID_ARGUMENT "name: ..." if the data is damaged or truncated.
absl::StatusOr<std::string> Inflate(std::string_view name, std::string_view bytes, std::size_t max_bytes);

// The same for deflate data without header and checksum; bytes behind its end are ignored.
absl::StatusOr<std::string> InflateRaw(std::string_view name, std::string_view bytes, std::size_t max_bytes);

// Returns the data in gzip format, level 6.
std::string Deflate(std::string_view bytes);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_GZIP_H_
