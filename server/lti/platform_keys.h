// The public keys of a learning platform, fetched when they are needed.
#ifndef PHRENIC_SERVER_LTI_PLATFORM_KEYS_H_
#define PHRENIC_SERVER_LTI_PLATFORM_KEYS_H_

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/access/key_set.h"

namespace phrenic::lti {

// Thread-safe. Keeps a set for an hour; a token that no key has signed makes it fetch the set anew, so that a platform
// may change its keys at any time. Fetches at most every 10 s, however many forged tokens come. While a fetch fails,
// the last set is used until it is 24 hours old.
class PlatformKeys {
 public:
  // Returns the document at an address; access::Fetch, or that of a test.
  using FetchText = std::function<absl::StatusOr<std::string>(const std::string& address)>;
  PlatformKeys(std::string url, FetchText fetch) : url_(std::move(url)), fetch_(std::move(fetch)) {}

  // Returns the claims of a token (access::KeySet::Verified). UNAUTHENTICATED if no key has signed it; UNAVAILABLE if
  // the keys cannot be fetched.
  absl::StatusOr<std::string> Verified(std::string_view token, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // Returns the kept set, or a new one if that is older than `age`. Fetches with the mutex held: others wait for it.
  absl::StatusOr<std::shared_ptr<const access::KeySet>> Keys(absl::Duration age, absl::Time now)
      ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Renew(absl::Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string url_;
  const FetchText fetch_;
  absl::Mutex mutex_;
  std::shared_ptr<const access::KeySet> keys_ ABSL_GUARDED_BY(mutex_);
  absl::Time fetched_ ABSL_GUARDED_BY(mutex_) = absl::InfinitePast();  // when keys_ came
  absl::Time tried_ ABSL_GUARDED_BY(mutex_) = absl::InfinitePast();
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_PLATFORM_KEYS_H_
