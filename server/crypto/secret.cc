#include "server/crypto/secret.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <array>
#include <cstdlib>

#include "absl/strings/escaping.h"

namespace phrenic {

std::string NewToken() {
  std::array<unsigned char, 16> bits;
  // Without randomness no secret is safe: the program cannot continue.
  if (RAND_bytes(bits.data(), static_cast<int>(bits.size())) != 1) std::abort();
  return absl::BytesToHexString({reinterpret_cast<const char*>(bits.data()), bits.size()});
}

bool SameToken(std::string_view a, std::string_view b) {
  return !a.empty() && a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace phrenic
