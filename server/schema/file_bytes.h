// Reads files whole.
#ifndef PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_
#define PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_

#include <optional>
#include <string>

namespace phrenic {

// Returns the file's bytes; nullopt if it is a folder, does not exist or cannot be read. Never throws, as iterators
// over a stream of a folder do. Thread-safe.
std::optional<std::string> ReadBytes(const std::string& file);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_FILE_BYTES_H_
