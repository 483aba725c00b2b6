// gzip (RFC 1952), by zlib.
#ifndef PHRENIC_SERVER_IMAGING_GZIP_H_
#define PHRENIC_SERVER_IMAGING_GZIP_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::imaging {

bool IsGzip(std::string_view bytes);

// The first `most` bytes of what `bytes` hold, or all where that is less; no more memory than that is ever taken. Where
// all is read the checksum is held too. INVALID_ARGUMENT "name: ..." for bytes that are damaged or cut off.
absl::StatusOr<std::string> Inflate(std::string_view name, std::string_view bytes, std::size_t most);

std::string Deflate(std::string_view bytes);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_GZIP_H_
