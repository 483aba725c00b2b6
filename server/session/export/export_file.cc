#include "server/session/export/export_file.h"

#include <utility>

namespace phrenic::session {

ExportFile::ExportFile(std::shared_ptr<record::SpoolFile> spool) : spool_(std::move(spool)) {}

absl::Status ExportFile::Append(std::string_view bytes) {
  hash_.Add(bytes);
  return spool_->Append(bytes);
}

}  // namespace phrenic::session
