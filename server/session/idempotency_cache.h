// What a session answered to requests that named an id, so that a repeat of one is answered alike and done once.
#ifndef PHRENIC_SERVER_SESSION_IDEMPOTENCY_CACHE_H_
#define PHRENIC_SERVER_SESSION_IDEMPOTENCY_CACHE_H_

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::session {

struct Answer {
  absl::Status status;
  std::string bytes;  // of the response, where the status is OK
};

// Any thread may call. Remembers the last kMostAnswers ids that were answered.
class IdempotencyCache {
 public:
  // Waits while the same request is under way. Its answer where it was given before; where not, the caller carries the
  // request out and calls Keep or Forget. INVALID_ARGUMENT where the id was that of another content, or is none
  // (schema::CheckId).
  absl::StatusOr<std::optional<Answer>> Begin(const std::string& id, const std::string& content)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void Keep(const std::string& id, Answer answer) ABSL_LOCKS_EXCLUDED(mutex_);
  // Nothing was changed: a repeat begins anew.
  void Forget(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Entry {
    std::string id;
    std::string digest;            // of the content
    std::optional<Answer> answer;  // none: under way
  };
  using Entries = std::deque<Entry>;

  Entries::iterator Find(const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool UnderWay(const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  absl::Mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);  // the oldest first
};

inline constexpr std::size_t kMostAnswers = 64;

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_IDEMPOTENCY_CACHE_H_
