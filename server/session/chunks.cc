#include "server/session/chunks.h"

#include <algorithm>
#include <utility>

#include "absl/strings/escaping.h"

namespace phrenic::session {
namespace {

constexpr std::size_t kChunk = 128 << 10;  // [bytes]

}  // namespace

Chunks::Chunks(std::function<absl::Status(std::string_view bytes)> send)
    : send_(std::move(send)), hash_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  EVP_DigestInit_ex(hash_.get(), EVP_sha256(), nullptr);
}

absl::Status Chunks::Add(std::string_view bytes) {
  bytes_ += static_cast<std::int64_t>(bytes.size());
  EVP_DigestUpdate(hash_.get(), bytes.data(), bytes.size());
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), kChunk - waiting_.size());
    waiting_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (waiting_.size() < kChunk) break;
    if (absl::Status status = Flush(); !status.ok()) return status;
  }
  return absl::OkStatus();
}

absl::Status Chunks::Flush() {
  if (waiting_.empty()) return absl::OkStatus();
  absl::Status status = send_(waiting_);
  waiting_.clear();
  return status;
}

std::string Chunks::Sha256() {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  EVP_DigestFinal_ex(hash_.get(), digest, &size);
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), size));
}

}  // namespace phrenic::session
