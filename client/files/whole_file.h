// Files that are there whole or not at all.
#ifndef PHRENIC_CLIENT_FILES_WHOLE_FILE_H_
#define PHRENIC_CLIENT_FILES_WHOLE_FILE_H_

#include <string>

#include "absl/status/status.h"

namespace phrenic::client {

// Writes FILE.part and renames it; DATA_LOSS names the file where that cannot be.
absl::Status WriteWhole(const std::string& file, const std::string& bytes);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_WHOLE_FILE_H_
