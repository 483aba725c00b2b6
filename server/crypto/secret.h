// Bearer tokens: 128 random bits in hexadecimal. They must not appear in a log, an address or an error.
#ifndef PHRENIC_SERVER_CRYPTO_SECRET_H_
#define PHRENIC_SERVER_CRYPTO_SECRET_H_

#include <string>
#include <string_view>

namespace phrenic {

// Returns a new token from OpenSSL's generator, which the system seeds. Thread-safe. Aborts if there is no randomness.
std::string NewToken();

// Compares in constant time, against timing attacks. An empty token equals no token.
bool SameToken(std::string_view a, std::string_view b);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_CRYPTO_SECRET_H_
