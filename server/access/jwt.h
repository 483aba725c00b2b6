// Verifies the signed tokens (JWT, RFC 7519) of an OpenID Connect identity provider with the provider's keys.
#ifndef PHRENIC_SERVER_ACCESS_JWT_H_
#define PHRENIC_SERVER_ACCESS_JWT_H_

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/access/caller.h"
#include "server/access/key_set.h"

namespace phrenic::access {

// Options of the server, constant while it runs.
struct JwtOptions {
  // File or address of a JSON Web Key Set (RFC 7517), or of an OpenID Connect configuration (Discovery 1.0 section 3)
  // whose "jwks_uri" names one; empty: no tokens are accepted.
  std::string keys;
  std::string issuer;    // required value of "iss"
  std::string audience;  // required value of "aud", or of one of its elements
  std::string name_claim = "sub";
  std::string role_claim = "phrenic_role";  // "viewer" to "admin", or a list that contains one
};

// Returns "jwt:ISSUER#SUBJECT". No account of a token file can have such a name.
std::string JwtAccountName(std::string_view issuer, std::string_view subject);

// Checks a token's claims, as JSON text, but not its signature: the part of JwtKeys::Check that reads what a client has
// written. Thread-safe. UNAUTHENTICATED with the reason.
absl::StatusOr<Account> ReadJwtClaims(std::string_view claims, const JwtOptions& options, absl::Time now);

// Immutable and thread-safe. Accounts shares one between calls and replaces it when the keys change.
class JwtKeys {
 public:
  // Reads the key set. INVALID_ARGUMENT, with the file and the reason, if it is not JSON or has no RSA or EC key; the
  // errors of Fetch. INVALID_ARGUMENT also without an issuer or an audience. Symmetric keys are ignored: anyone who can
  // read a public set could sign with them.
  static absl::StatusOr<std::shared_ptr<const JwtKeys>> Read(const JwtOptions& options);

  // Returns the account that a token names. UNAUTHENTICATED, with the reason, if the signature is not by a key of the
  // set with RS, PS or ES (RFC 7518 section 3.1), if the header has extensions that must be understood ("crit", RFC
  // 7515 section 4.1.11), or if issuer, audience, time ("exp" is required; "exp", "nbf" and "iat" must be numbers;
  // clocks may differ by 60 s), name (1 to 255 bytes that can be printed on one line) or role are not accepted (RFC
  // 7519 section 4.1). Also UNAUTHENTICATED for a token above 16 KiB. The account gets the highest role that the token
  // names.
  absl::StatusOr<Account> Check(std::string_view token, absl::Time now) const;

 private:
  JwtKeys(JwtOptions options, std::shared_ptr<const KeySet> keys)
      : options_(std::move(options)), keys_(std::move(keys)) {}

  const JwtOptions options_;
  const std::shared_ptr<const KeySet> keys_;
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_JWT_H_
