// FILE.part: what has arrived of FILE, until it is whole.
#ifndef PHRENIC_CLIENT_FILES_PART_FILE_H_
#define PHRENIC_CLIENT_FILES_PART_FILE_H_

#include <cstdint>
#include <fstream>
#include <string>

#include "absl/status/status.h"
#include "server/schema/sha256.h"

namespace phrenic::client {

// Not thread-safe. Removed by the destructor unless it is in its place or `keep` holds.
class PartFile {
 public:
  // Where `keep` holds, what is there already counts as arrived.
  PartFile(const std::string& file, bool keep);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  // DATA_LOSS names the file where it cannot be written.
  absl::Status Write(const std::string& bytes);
  std::int64_t bytes() const { return bytes_; }
  // DATA_LOSS where the file is not the one with that SHA-256.
  absl::Status PutInPlace(const std::string& sha256);

 private:
  void TakeWhatIsThere();
  absl::Status Error() const;

  const std::string file_, part_;
  const bool keep_;
  bool damaged_ = false;
  std::int64_t bytes_ = 0;
  Sha256 hash_;
  std::ofstream out_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PART_FILE_H_
