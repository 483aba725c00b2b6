#include "client/part_file.h"

#include <cstdio>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace phrenic::client {

PartFile::PartFile(const std::string& file, bool keep)
    : file_(file), part_(file + ".part"), keep_(keep), hash_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr);
  if (keep_) TakeWhatIsThere();
  out_.open(part_, bytes_ > 0 ? std::ios::binary | std::ios::app : std::ios::binary | std::ios::trunc);
}

PartFile::~PartFile() {
  out_.close();
  if (!keep_ || damaged_) std::remove(part_.c_str());
}

void PartFile::TakeWhatIsThere() {
  std::ifstream in(part_, std::ios::binary);
  std::string block(std::size_t{1} << 20, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    EVP_DigestUpdate(hash_.get(), block.data(), static_cast<std::size_t>(in.gcount()));
    bytes_ += in.gcount();
  }
}

absl::Status PartFile::Write(const std::string& bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  EVP_DigestUpdate(hash_.get(), bytes.data(), bytes.size());
  bytes_ += static_cast<std::int64_t>(bytes.size());
  return out_ ? absl::OkStatus() : Error();
}

absl::Status PartFile::Error() const {
  return absl::DataLossError(absl::StrCat("cannot write ", part_, ": is the folder there, and the disk not full?"));
}

absl::Status PartFile::PutInPlace(const std::string& sha256) {
  out_.close();
  if (!out_) return Error();
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(hash_.get(), digest, &size);
  const std::string hex = absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), size));
  damaged_ = hex != sha256;
  if (damaged_) return absl::DataLossError(absl::StrCat(file_, " arrived damaged: try again"));
  if (std::rename(part_.c_str(), file_.c_str()) == 0) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("cannot rename ", part_, " to ", file_));
}

}  // namespace phrenic::client
