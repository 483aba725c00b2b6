// The answers to requests that have an id, so that a repeated request is executed once and answered the same.
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
  absl::Status status;  // of the first execution
  std::string bytes;    // of the response, where the status is OK
};

// Keeps the last kMostAnswers answers. Thread-safe. Each session has one, and its answers end with it. mutex_ is not
// held while a request is executed.
class IdempotencyCache {
 public:
  // Waits while a request with this id is in progress, then returns its answer. Returns nullopt if the id is new: the
  // caller executes the request and calls Keep or Forget. INVALID_ARGUMENT if the id had another content, or is not
  // valid (schema::CheckId). `content` is the serialized request; the cache keeps its SHA-256 alone. Each nullopt is
  // followed by one Keep or Forget; until then, others with this id wait.
  absl::StatusOr<std::optional<Answer>> Begin(const std::string& id, const std::string& content)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Keeps the answer to the request in progress. Drops the oldest answer past kMostAnswers; requests in progress are
  // never dropped. Requires: Begin returned nullopt for the id.
  void Keep(const std::string& id, Answer answer) ABSL_LOCKS_EXCLUDED(mutex_);
  // Forgets the request in progress, which has changed nothing: a repeat is executed. Requires: Begin returned nullopt
  // for the id.
  void Forget(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Entry {
    std::string id;
    std::string digest;            // of the content; SHA-256 in hexadecimal
    std::optional<Answer> answer;  // nullopt: in progress
  };
  using Entries = std::deque<Entry>;

  // Linear search; the end if there is no such entry.
  Entries::iterator Find(const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool InProgress(const std::string& id) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  absl::Mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);  // oldest first
};

// Of one session.
inline constexpr std::size_t kMostAnswers = 64;

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_IDEMPOTENCY_CACHE_H_
