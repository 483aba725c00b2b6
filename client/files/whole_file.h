// Files read and written as a whole.
#ifndef PHRENIC_CLIENT_FILES_WHOLE_FILE_H_
#define PHRENIC_CLIENT_FILES_WHOLE_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace phrenic::client {

// Returns the file's bytes. NOT_FOUND, "cannot read the scene file x.textproto: ...", if it is not a readable file;
// `what` describes the file, such as "the scene file".
absl::StatusOr<std::string> ReadWhole(const std::string& file, const std::string& what);

// True if the path exists and is neither a regular file nor a folder: a device, a pipe or a socket, which is written to
// and never replaced (/dev/null, /dev/stdout).
bool IsDevice(const std::string& file);

// Writes FILE.part and renames it to FILE, so that FILE is never incomplete; a device is written directly. DATA_LOSS
// names the file if it cannot be written.
absl::Status WriteWhole(const std::string& file, const std::string& bytes);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_WHOLE_FILE_H_
