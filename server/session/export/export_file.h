// The spool file of an export, with its hash.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_

#include <memory>
#include <string>
#include <string_view>

#include "server/crypto/sha256.h"
#include "server/record/spool_file.h"

namespace phrenic::session {

// Appends to a spool file and hashes what it appends. Not thread-safe; any number of threads may read spool().
// ExportMotion appends through it, on the thread of the job.
class ExportFile {
 public:
  explicit ExportFile(std::shared_ptr<record::SpoolFile> spool);

  // The errors of record::SpoolFile::Append; after one, the hash is not that of the file.
  absl::Status Append(std::string_view bytes);
  // Returns the SHA-256 of everything appended, in hexadecimal. Ends the hash: call it once, at the end.
  std::string Sha256Digits() { return hash_.Hex(); }
  const std::shared_ptr<record::SpoolFile>& spool() const { return spool_; }

 private:
  const std::shared_ptr<record::SpoolFile> spool_;
  Sha256 hash_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_
