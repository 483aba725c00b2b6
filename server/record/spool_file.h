// Files without a name: work of more bytes than memory should hold, gone when it is let go, however the program ends.
#ifndef PHRENIC_SERVER_RECORD_SPOOL_FILE_H_
#define PHRENIC_SERVER_RECORD_SPOOL_FILE_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::record {

// The folder for spool files where none is said: TMPDIR, or /var/tmp, which is a disk where /tmp may be memory.
std::string DefaultSpoolFolder();

// RESOURCE_EXHAUSTED names the folder, the bytes needed and the bytes free where there is not that much room; NOT_FOUND
// where there is no such folder.
absl::Status CheckRoom(const std::string& folder, std::int64_t bytes);

// One thread appends; any number may read what was appended before.
class SpoolFile {
 public:
  // NOT_FOUND or PERMISSION_DENIED names the folder.
  static absl::StatusOr<std::unique_ptr<SpoolFile>> Open(const std::string& folder);
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  // RESOURCE_EXHAUSTED as CheckRoom where the disk is full.
  absl::Status Append(std::string_view bytes);
  // Fills `to` from `offset` on; OUT_OF_RANGE where the file has not that many bytes.
  absl::Status Read(std::int64_t offset, char* to, std::size_t count) const;
  std::int64_t size() const { return size_; }

 private:
  SpoolFile(std::string folder, int descriptor) : folder_(std::move(folder)), descriptor_(descriptor) {}

  const std::string folder_;
  const int descriptor_;
  std::atomic<std::int64_t> size_ = 0;
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_SPOOL_FILE_H_
