// Tokens that the server itself issues to accounts of other systems, such as a school's, for hours.
#ifndef PHRENIC_SERVER_ACCESS_ISSUED_TOKENS_H_
#define PHRENIC_SERVER_ACCESS_ISSUED_TOKENS_H_

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/access/caller.h"

namespace phrenic::access {

// Thread-safe. Accounts has one. In memory alone: no token outlives the server. Keeps the SHA-256 of 10,000 tokens; the
// one that expires first makes room.
class IssuedTokens {
 public:
  // Returns a new token of the account, which is valid until `expires`.
  std::string Issue(const Account& account, absl::Time expires) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the account of the token with this SHA-256; nullopt if it is unknown or has expired.
  std::optional<Account> Find(std::string_view sha256, absl::Time now) const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Issued {
    Account account;
    absl::Time expires;
  };

  mutable absl::Mutex mutex_;
  std::map<std::string, Issued, std::less<>> tokens_ ABSL_GUARDED_BY(mutex_);  // by SHA-256
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_ISSUED_TOKENS_H_
