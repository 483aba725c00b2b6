// Unnamed temporary files (O_TMPFILE) for data that should not be in memory. The kernel deletes them when they are
// closed, even if the program crashes.
#ifndef PHRENIC_SERVER_RECORD_SPOOL_FILE_H_
#define PHRENIC_SERVER_RECORD_SPOOL_FILE_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::record {

// Returns TMPDIR, or /var/tmp, which is on disk where /tmp may be in memory.
std::string DefaultSpoolFolder();

// Checks that `bytes` fit into 95 % of the free space. RESOURCE_EXHAUSTED names the folder, the space needed and the
// free space; NOT_FOUND if the folder does not exist. It reserves nothing: other programs may take the space. INTERNAL
// or PERMISSION_DENIED if the free space cannot be read.
absl::Status CheckRoom(const std::string& folder, std::int64_t bytes);

// One thread may append while others read what was appended before. Uploads, exports and recorders hold one, often
// shared; its space is free again when the last one is gone.
class SpoolFile {
 public:
  // Creates a file. NOT_FOUND or PERMISSION_DENIED names the folder. On a file system without O_TMPFILE it creates a
  // file of mode 0600 and removes its name at once. INTERNAL for other failures.
  static absl::StatusOr<std::unique_ptr<SpoolFile>> Open(const std::string& folder);
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  // RESOURCE_EXHAUSTED, as CheckRoom, if the disk is full. Only one thread at a time. After an error, size() counts the
  // bytes that were written before it.
  absl::Status Append(std::string_view bytes);
  // Reads `count` bytes from `offset` into `to`. OUT_OF_RANGE if the file is shorter. Thread-safe. INTERNAL if the disk
  // fails.
  absl::Status Read(std::int64_t offset, char* to, std::size_t count) const;
  // Returns the number of bytes appended.
  std::int64_t size() const { return size_; }

 private:
  SpoolFile(std::string folder, int descriptor) : folder_(std::move(folder)), descriptor_(descriptor) {}

  const std::string folder_;  // for error messages
  const int descriptor_;
  std::atomic<std::int64_t> size_ = 0;
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_SPOOL_FILE_H_
