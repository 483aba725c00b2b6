// The identity of a caller. Plain data.
#ifndef PHRENIC_SERVER_ACCESS_CALLER_H_
#define PHRENIC_SERVER_ACCESS_CALLER_H_

#include <string>
#include <vector>

#include "phrenic/v1/access.pb.h"

namespace phrenic::access {

// The names of both kinds differ by the prefix "jwt:", so that neither can pass for the other.
struct Account {
  std::string name;  // "anna" of the token file; "jwt:ISSUER#anna" of the identity provider
  v1::AccessRole role = v1::ACCESS_ROLE_UNSPECIFIED;  // the highest role outside of the account's own sessions
  std::string token_sha256 = "";                      // key in the token file; empty: from the identity provider
};

// AccessGuard makes one for each call.
struct Caller {
  Account account;                 // without a name if the caller is not authenticated
  std::vector<std::string> links;  // SHA-256 of the secret of each join link sent with the call
  std::string peer;                // IP address; empty: this process

  // True if the caller has an account.
  bool known() const { return !account.name.empty(); }
  // True for an administrator, who counts as the owner of every session (AccessGuard::Owns).
  bool admin() const { return account.role == v1::ACCESS_ROLE_ADMIN; }
  // Returns the name under which the caller owns resources. Guests are distinguished by their first link.
  std::string id() const {
    constexpr std::size_t kShort = 12;
    return known() || links.empty() ? account.name : "guest " + links.front().substr(0, kShort);
  }
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_CALLER_H_
