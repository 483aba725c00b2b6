// Finds the viewer's files below one folder.
#ifndef PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_
#define PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::service {

struct StaticFile {
  std::string path;
  std::string content_type;
  std::string etag;           // strong validator from size and modification time, in quotes (RFC 9110 section 8.8.3)
  std::string cache_control;  // files in assets/ have a content hash in their name and are cached as immutable
};

// Returns the file that a request target names; "/" is index.html. Thread-safe.
// Errors: NOT_FOUND if there is no such file or if it is outside `root`, by ".." or a symbolic link; INVALID_ARGUMENT
// if the target is malformed.
absl::StatusOr<StaticFile> FindStaticFile(const std::string& root, std::string_view target);

// Returns the media type for a file extension; "application/octet-stream" if it is unknown.
std::string ContentTypeOf(std::string_view path);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_
