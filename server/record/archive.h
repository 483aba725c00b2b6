// Writes several files as one: an uncompressed zip archive, streamed to a sink.
#ifndef PHRENIC_SERVER_RECORD_ARCHIVE_H_
#define PHRENIC_SERVER_RECORD_ARCHIVE_H_

#include <memory>
#include <string>
#include <string_view>

#include "server/record/recorder.h"

struct archive;

namespace phrenic::record {

// Not thread-safe. Methods return the sink's error, or INTERNAL. The .pvd recorder owns one. The sink gets the bytes in
// order, on the calling thread; only the archive's directory is kept in memory.
class Archive {
 public:
  explicit Archive(Sink sink);
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  // Adds a file with mode 0644. `name` is its path in the archive, with "/" between folders; `bytes` are its whole
  // content.
  absl::Status Add(const std::string& name, std::string_view bytes);
  // Writes the archive's directory. Call once, last.
  absl::Status Finish();

 private:
  // Returns the sink's first error; else OK for ARCHIVE_OK, and INTERNAL with libarchive's message for other codes.
  absl::Status Check(int code) const;

  struct Receiver {
    Sink sink;
    absl::Status status;  // the sink's first error
  };
  Receiver receiver_;   // libarchive has a pointer to it
  archive* const zip_;  // of libarchive; freed by the destructor
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_ARCHIVE_H_
