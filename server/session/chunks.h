// The bytes of a file on their way out, in chunks of a useful size, counted and hashed.
#ifndef PHRENIC_SERVER_SESSION_CHUNKS_H_
#define PHRENIC_SERVER_SESSION_CHUNKS_H_

#include <openssl/evp.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace phrenic::session {

// Chunks of 128 kB, the last one shorter. Not thread-safe.
class Chunks {
 public:
  explicit Chunks(std::function<absl::Status(std::string_view bytes)> send);

  absl::Status Add(std::string_view bytes);
  // Sends what is left.
  absl::Status Flush();
  std::int64_t bytes() const { return bytes_; }
  // Of everything, in hexadecimal; ends the hash, so call it once, at the end.
  std::string Sha256();

 private:
  const std::function<absl::Status(std::string_view bytes)> send_;
  std::string waiting_;
  std::int64_t bytes_ = 0;
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> hash_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_CHUNKS_H_
