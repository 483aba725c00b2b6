// Extracts archives.
#ifndef PHRENIC_CLIENT_FILES_UNPACK_H_
#define PHRENIC_CLIENT_FILES_UNPACK_H_

#include <string>

#include "absl/status/status.h"

namespace phrenic::client {

// Extracts a zip archive into `folder`, in the archive's order, and overwrites existing files. DATA_LOSS if the archive
// names a path outside the folder or cannot be read, or if a file cannot be written.
absl::Status Unpack(const std::string& archive, const std::string& folder);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_UNPACK_H_
