// Who has an account: by a file of tokens, and by an identity provider's signed ones.
#ifndef PHRENIC_SERVER_ACCESS_ACCOUNTS_H_
#define PHRENIC_SERVER_ACCESS_ACCOUNTS_H_

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/access/jwt.h"
#include "server/access/token_file.h"

namespace phrenic::access {

struct AccountOptions {
  std::string tokens_file;  // empty: none
  JwtOptions jwt;

  bool used() const { return !tokens_file.empty() || !jwt.keys.empty(); }
};

// Any thread may call. Files that change, and keys of an address after a while, are read again by Refresh; where they
// are not good, what they held before stays.
class Accounts {
 public:
  // What is wrong with a file.
  static absl::StatusOr<std::unique_ptr<Accounts>> Open(AccountOptions options);

  // Whether calls need one.
  bool required() const { return options_.used(); }
  // UNAUTHENTICATED where the token is nobody's.
  absl::StatusOr<Account> Check(std::string_view token) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Whether its file has it still; true for one that no file has.
  bool StillHas(const Account& account) const ABSL_LOCKS_EXCLUDED(mutex_);
  // To be called now and then; what is wrong with a file that changed, or with an address.
  absl::Status Refresh() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  explicit Accounts(AccountOptions options) : options_(std::move(options)) {}
  absl::Status ReadTokenFile() ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status ReadKeys() ABSL_LOCKS_EXCLUDED(mutex_);

  const AccountOptions options_;
  // Of who calls Refresh.
  std::filesystem::file_time_type tokens_changed_, keys_changed_;
  absl::Time keys_due_;  // of an address
  mutable absl::Mutex mutex_;
  std::shared_ptr<const TokenTable> tokens_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<const JwtKeys> keys_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_ACCOUNTS_H_
