// Tokens of an identity provider (OpenID Connect): signed JSON (RFC 7519), checked by cjose with the provider's keys.
#ifndef PHRENIC_SERVER_ACCESS_JWT_H_
#define PHRENIC_SERVER_ACCESS_JWT_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/access/caller.h"

namespace phrenic::access {

struct JwtOptions {
  // A file, or an address, of a JSON Web Key Set (RFC 7517), or of an OpenID Connect configuration, whose "jwks_uri"
  // has one; empty: none are taken.
  std::string keys;
  std::string issuer;    // "iss" must be this
  std::string audience;  // "aud" must be, or hold, this
  std::string name_claim = "sub";
  std::string role_claim = "phrenic_role";  // "viewer" .. "admin", or a list with one of them
};

// Immutable: any thread may call.
class JwtKeys {
 public:
  // INVALID_ARGUMENT with the file and what is wrong: no JSON, no key that signs. The errors of Fetch.
  static absl::StatusOr<std::shared_ptr<const JwtKeys>> Read(const JwtOptions& options);
  JwtKeys(const JwtKeys&) = delete;
  JwtKeys& operator=(const JwtKeys&) = delete;
  ~JwtKeys();

  // The account that a token names. UNAUTHENTICATED says what is wrong with it: its signature, by a key of the set and
  // RS, PS or ES alone; issuer, audience, times ("exp" must be there), name or role.
  absl::StatusOr<Account> Check(std::string_view token, absl::Time now) const;

 private:
  explicit JwtKeys(JwtOptions options);
  absl::StatusOr<std::string> VerifiedClaims(std::string_view token) const;

  const JwtOptions options_;
  struct Key;
  std::vector<std::unique_ptr<Key>> keys_;
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_JWT_H_
