// Archives of several files, taken apart.
#ifndef PHRENIC_CLIENT_FILES_UNPACK_H_
#define PHRENIC_CLIENT_FILES_UNPACK_H_

#include <string>

#include "absl/status/status.h"

namespace phrenic::client {

// Writes the files of a zip archive below `folder`, in the archive's order, over what is there of the same name.
// INVALID_ARGUMENT for an archive that names a place outside, DATA_LOSS where something cannot be written.
absl::Status Unpack(const std::string& archive, const std::string& folder);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_UNPACK_H_
