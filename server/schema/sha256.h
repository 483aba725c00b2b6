// SHA-256 (FIPS 180-4), by which scenes, uploads and exports are known and checked.
#ifndef PHRENIC_SERVER_SCHEMA_SHA256_H_
#define PHRENIC_SERVER_SCHEMA_SHA256_H_

#include <openssl/evp.h>

#include <memory>
#include <string>
#include <string_view>

namespace phrenic {

// Of bytes that come in parts. Not thread-safe.
class Sha256 {
 public:
  Sha256();

  void Add(std::string_view bytes);
  // Of everything added, 64 hexadecimal digits; ends the hash, so call it once, at the end.
  std::string Hex();

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

std::string Sha256Hex(std::string_view bytes);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_SHA256_H_
