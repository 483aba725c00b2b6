// The viewer's files below one folder.
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
  std::string etag;           // of size and time of change, in quotes
  std::string cache_control;  // files below assets/ have a hash in their names and never change
};

// The file that an HTTP request's target names; "/" is index.html. NOT_FOUND where there is none, or where the target
// leads out of `root`, by ".." or by a link; INVALID_ARGUMENT for a target that is not well formed. Any thread may
// call.
absl::StatusOr<StaticFile> FindStaticFile(const std::string& root, std::string_view target);

// By the file's ending; "application/octet-stream" for one that is not known.
std::string ContentTypeOf(std::string_view path);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_
