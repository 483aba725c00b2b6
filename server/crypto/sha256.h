// SHA-256 (FIPS 180-4): identifies and checks scenes, uploads and exports.
#ifndef PHRENIC_SERVER_CRYPTO_SHA256_H_
#define PHRENIC_SERVER_CRYPTO_SHA256_H_

#include <openssl/evp.h>

#include <memory>
#include <string>
#include <string_view>

namespace phrenic {

// Hashes bytes that arrive in parts. Not thread-safe.
class Sha256 {
 public:
  Sha256();

  void Add(std::string_view bytes);
  // Returns the hash of everything added, 64 hexadecimal digits. To be called once, at the end.
  std::string Hex();

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

// Returns the hash of `bytes`, 64 hexadecimal digits.
std::string Sha256Hex(std::string_view bytes);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_CRYPTO_SHA256_H_
