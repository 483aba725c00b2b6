// HMAC-SHA-256 (RFC 2104), of OpenSSL: signs what the server hands out and takes back.
#ifndef PHRENIC_SERVER_CRYPTO_HMAC_H_
#define PHRENIC_SERVER_CRYPTO_HMAC_H_

#include <string>
#include <string_view>

namespace phrenic {

// Returns the code of `bytes` under `key`, 64 hexadecimal digits. Compare codes by SameToken. Thread-safe.
std::string HmacSha256Hex(std::string_view key, std::string_view bytes);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_CRYPTO_HMAC_H_
