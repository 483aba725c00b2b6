// SHA-256, by which exports and uploads are checked.
#ifndef PHRENIC_TESTS_SESSION_SHA256_H_
#define PHRENIC_TESTS_SESSION_SHA256_H_

#include <openssl/sha.h>

#include <string>

#include "absl/strings/escaping.h"

namespace phrenic::session {

// In hexadecimal.
inline std::string Sha256(const std::string& bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  return absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), sizeof digest));
}

}  // namespace phrenic::session

#endif  // PHRENIC_TESTS_SESSION_SHA256_H_
