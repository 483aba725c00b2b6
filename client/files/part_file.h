// A file that is being downloaded.
#ifndef PHRENIC_CLIENT_FILES_PART_FILE_H_
#define PHRENIC_CLIENT_FILES_PART_FILE_H_

#include <cstdint>
#include <fstream>
#include <string>

#include "absl/status/status.h"
#include "server/crypto/sha256.h"

namespace phrenic::client {

// Collects the bytes of FILE in FILE.part and renames it once it is complete. The destructor removes FILE.part unless
// `keep` is true. A device (IsDevice) is written directly. Not thread-safe.
class PartFile {
 public:
  // If `keep` is true, an existing FILE.part counts as already downloaded.
  PartFile(const std::string& file, bool keep);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  // Appends bytes. DATA_LOSS names the file if it cannot be written.
  absl::Status Write(const std::string& bytes);
  // Number of bytes in FILE.part.
  std::int64_t bytes() const { return bytes_; }
  // Renames FILE.part to FILE. DATA_LOSS if the SHA-256 of its bytes differs or it cannot be renamed.
  absl::Status Finish(const std::string& sha256);

 private:
  void ReadExistingPart();
  absl::Status Error() const;

  const bool device_;
  const std::string file_, part_;  // the same for a device
  const bool keep_;
  bool damaged_ = false;
  std::int64_t bytes_ = 0;
  Sha256 hash_;
  std::ofstream out_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PART_FILE_H_
