// Writes several files as one: an uncompressed zip archive, streamed to a sink.
#ifndef PHRENIC_SERVER_RECORD_ARCHIVE_H_
#define PHRENIC_SERVER_RECORD_ARCHIVE_H_

#include <memory>
#include <string>
#include <string_view>

#include "server/record/recorder.h"

struct archive;

namespace phrenic::record {

// Not thread-safe. Methods return the sink's error, or INTERNAL.
class Archive {
 public:
  explicit Archive(Sink sink);
  ~Archive();
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  absl::Status Add(const std::string& name, std::string_view bytes);
  // Writes the archive's directory. Call once, last.
  absl::Status Finish();

 private:
  absl::Status Check(int code) const;

  struct Receiver {
    Sink sink;
    absl::Status status;
  };
  Receiver receiver_;
  archive* const zip_;
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_ARCHIVE_H_
