// Logins in progress: signed states that browsers carry, of which the server keeps only those that were used.
#ifndef PHRENIC_SERVER_LTI_LOGINS_H_
#define PHRENIC_SERVER_LTI_LOGINS_H_

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/crypto/secret.h"

namespace phrenic::lti {

// Thread-safe. A login costs no memory, so that logins of unknown callers do not push out those of a class. The key is
// new in each process: a restart ends the logins in progress.
class Logins {
 public:
  // A login that was begun: which platform, and what its token has to repeat.
  struct Login {
    std::size_t platform = 0;
    std::string nonce;
  };

  explicit Logins(absl::Duration lifetime) : lifetime_(lifetime) {}

  // Returns a new state for a platform, in characters of an address and a cookie; its first 32 are random.
  std::string Begin(std::size_t platform, absl::Time now) const;
  // Returns the login of a state; nullopt if this process has not signed it, or if it has expired.
  std::optional<Login> Read(const std::string& state, absl::Time now) const;
  // Marks a state as used, once its token was verified; only platforms can bring it so far. UNAUTHENTICATED if it was
  // used before, UNAVAILABLE if too many launches of the last minutes are kept to tell. Requires: Read returned it.
  absl::Status Use(const std::string& state, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  std::string NonceOf(const std::string& state) const;

  const absl::Duration lifetime_;
  const std::string key_ = NewToken() + NewToken();
  absl::Mutex mutex_;
  std::map<std::string, absl::Time> used_ ABSL_GUARDED_BY(mutex_);  // states, and when they expire
};

// Most launches within the lifetime of a login.
inline constexpr std::size_t kMostUsedLogins = 100'000;

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_LOGINS_H_
