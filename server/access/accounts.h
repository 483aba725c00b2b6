// The accounts of a server: tokens from a file, and signed tokens of an OpenID Connect identity provider.
#ifndef PHRENIC_SERVER_ACCESS_ACCOUNTS_H_
#define PHRENIC_SERVER_ACCESS_ACCOUNTS_H_

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/access/issued_tokens.h"
#include "server/access/jwt.h"
#include "server/access/token_file.h"

namespace phrenic::access {

struct AccountOptions {
  std::string tokens_file;  // empty: no token file
  JwtOptions jwt;           // without keys: no identity provider

  // True if there are accounts at all.
  bool used() const { return !tokens_file.empty() || !jwt.keys.empty(); }
};

// Thread-safe, except that one thread at a time calls Refresh. Refresh reloads changed files, and keys from an address
// every minute; if the new content is not valid, the previous content stays in use. The server owns one and refreshes
// it periodically (service/server.cc). A change takes effect for the next call of Check.
class Accounts {
 public:
  // Reads the token file and the keys. Errors: those of ReadTokens and JwtKeys::Read. Waits for keys from an address,
  // 10 s at most for each document.
  static absl::StatusOr<std::unique_ptr<Accounts>> Open(AccountOptions options);

  // True if calls need an account.
  bool required() const { return options_.used(); }
  // Returns the account of a token. UNAUTHENTICATED if no account has it. Signatures are verified on the calling
  // thread, without the mutex.
  absl::StatusOr<Account> Check(std::string_view token) const ABSL_LOCKS_EXCLUDED(mutex_);
  // True if the token file still has the account; always true for accounts of the identity provider. For calls that
  // last: a watcher ends when its account is removed.
  bool StillHas(const Account& account) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the present name of an account that a version before the names of the identity provider's accounts began
  // with "jwt:" stored. Names of both kinds looked alike then: it is an account of the token file if that has one of
  // this name, and otherwise one of the provider's, if there is a provider.
  std::string Qualified(const std::string& stored) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns a new token for an account of another system (LTI), which Check accepts until `expires` or until the server
  // ends.
  std::string Issue(const Account& account, absl::Time expires) { return issued_.Issue(account, expires); }
  // Call it periodically. Returns the error of a changed file or of an address that cannot be read.
  absl::Status Refresh() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  explicit Accounts(AccountOptions options) : options_(std::move(options)) {}
  // Each replaces its part if the content is valid; the file or the address is read without the mutex.
  absl::Status ReadTokenFile() ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status ReadKeys() ABSL_LOCKS_EXCLUDED(mutex_);

  const AccountOptions options_;
  // Used by the thread that calls Refresh.
  std::filesystem::file_time_type tokens_changed_, keys_changed_;
  IssuedTokens issued_;
  absl::Time keys_due_;        // when keys from an address are fetched again
  mutable absl::Mutex mutex_;  // guards the pointers; what they point to is immutable
  std::shared_ptr<const TokenTable> tokens_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<const JwtKeys> keys_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_ACCOUNTS_H_
