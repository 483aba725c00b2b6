// Finds the viewer's files below one folder.
#ifndef PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_
#define PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::service {

// A file that exists, and the headers that go with it. The file may change or vanish before it is read.
struct StaticFile {
  std::string path;           // absolute, without symbolic links
  std::string content_type;   // ContentTypeOf
  std::string etag;           // strong validator from size and modification time, in quotes (RFC 9110 section 8.8.3)
  std::string cache_control;  // files in assets/ have a content hash in their name and are cached as immutable
  std::string encoding;       // Content-Encoding of a compressed file: "br", "gzip"; empty: as it is
  bool varies = false;        // another Accept-Encoding may get other bytes
};

// Returns the file that a request target names; "/" is index.html. Thread-safe. Query and fragment are ignored, and
// percent-encoding is decoded once. Looks at the disk at each call, so that a viewer built meanwhile is served; keeps
// nothing open. If `root` does not exist, NOT_FOUND says how to build it. Where the build wrote a compressed file
// beside it (FILE.br, FILE.gz; web/vite.config.ts), the smallest that `accept_encoding` allows is returned, with the
// media type of FILE. `accept_encoding` is the request's header (RFC 9110 section 12.5.3); "*" is ignored.
// Errors: NOT_FOUND if there is no such file or if it is outside `root`, by ".." or a symbolic link; INVALID_ARGUMENT
// if the target is malformed.
absl::StatusOr<StaticFile> FindStaticFile(const std::string& root, std::string_view target,
                                          std::string_view accept_encoding = "");

// Returns the media type for a file extension; "application/octet-stream" if it is unknown. Text types say UTF-8. Pure
// function, thread-safe.
std::string ContentTypeOf(std::string_view path);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_STATIC_FILES_H_
