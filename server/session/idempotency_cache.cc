#include "server/session/idempotency_cache.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"
#include "server/schema/id.h"

namespace phrenic::session {

IdempotencyCache::Entries::iterator IdempotencyCache::Find(const std::string& id) {
  return std::find_if(entries_.begin(), entries_.end(), [&id](const Entry& entry) { return entry.id == id; });
}

bool IdempotencyCache::InProgress(const std::string& id) {
  const auto entry = Find(id);
  return entry != entries_.end() && !entry->answer.has_value();
}

absl::StatusOr<std::optional<Answer>> IdempotencyCache::Begin(const std::string& id, const std::string& content) {
  if (absl::Status status = schema::CheckId("request_id", id); !status.ok()) return status;
  const std::string digest = Sha256Hex(content);  // contents may be large
  const auto free = [this, &id] {
    mutex_.AssertHeld();
    return !InProgress(id);
  };
  absl::MutexLock lock(&mutex_);
  mutex_.Await(absl::Condition(&free));
  const auto entry = Find(id);
  if (entry == entries_.end()) {
    entries_.push_back({id, digest, std::nullopt});
    return std::nullopt;
  }
  if (entry->digest == digest) return entry->answer;
  return absl::InvalidArgumentError(
      absl::StrCat("request_id: ", id,
                   " belongs to another request of this session; give each request its own id, and "
                   "repeat a request unchanged"));
}

void IdempotencyCache::Keep(const std::string& id, Answer answer) {
  absl::MutexLock lock(&mutex_);
  Find(id)->answer = std::move(answer);
  if (entries_.size() <= kMostAnswers) return;
  const auto oldest =
      std::find_if(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.answer.has_value(); });
  entries_.erase(oldest);
}

void IdempotencyCache::Forget(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  entries_.erase(Find(id));
}

}  // namespace phrenic::session
