#include "server/session/export_file.h"

#include <utility>

#include "absl/strings/escaping.h"

namespace phrenic::session {

ExportFile::ExportFile(std::shared_ptr<record::SpoolFile> spool)
    : spool_(std::move(spool)), hash_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr);
}

absl::Status ExportFile::Append(std::string_view bytes) {
  EVP_DigestUpdate(hash_.get(), bytes.data(), bytes.size());
  return spool_->Append(bytes);
}

std::string ExportFile::Sha256() {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(hash_.get(), digest, &size);
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), size));
}

}  // namespace phrenic::session
