// Reads files whole.
#ifndef PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_
#define PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_

#include <cstddef>
#include <optional>
#include <string>

namespace phrenic {

// Returns the file's bytes; nullopt if it is a folder, does not exist, cannot be read, or has more than `most` bytes.
// Never throws, as iterators over a stream of a folder do. Thread-safe.
std::optional<std::string> ReadBytes(const std::string& file, std::size_t most = std::string::npos);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_
