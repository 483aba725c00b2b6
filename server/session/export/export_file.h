// The bytes of an export on their way to the spool, counted and hashed.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_

#include <memory>
#include <string>
#include <string_view>

#include "server/record/spool_file.h"
#include "server/schema/sha256.h"

namespace phrenic::session {

// One thread appends; any number may read from `spool`.
class ExportFile {
 public:
  explicit ExportFile(std::shared_ptr<record::SpoolFile> spool);

  absl::Status Append(std::string_view bytes);
  // Of everything, in hexadecimal; ends the hash, so call it once, at the end.
  std::string Sha256Digits() { return hash_.Hex(); }
  const std::shared_ptr<record::SpoolFile>& spool() const { return spool_; }

 private:
  const std::shared_ptr<record::SpoolFile> spool_;
  Sha256 hash_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_FILE_H_
