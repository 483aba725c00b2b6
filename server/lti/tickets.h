// Secrets that are good for one use within a time.
#ifndef PHRENIC_SERVER_LTI_TICKETS_H_
#define PHRENIC_SERVER_LTI_TICKETS_H_

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/crypto/secret.h"

namespace phrenic::lti {

// What begins with a ticket and ends with it, such as a login. Thread-safe. Keeps the 10,000 newest.
template <class Value>
class Tickets {
 public:
  explicit Tickets(absl::Duration lifetime) : lifetime_(lifetime) {}

  // Returns a new ticket for the value, 32 hexadecimal digits.
  std::string Issue(Value value, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_) {
    std::string ticket = NewToken();
    absl::MutexLock lock(&mutex_);
    while (!order_.empty() && (order_.size() >= kMostTickets || IsOver(order_.front(), now))) {
      kept_.erase(order_.front());
      order_.pop_front();
    }
    order_.push_back(ticket);
    kept_.emplace(ticket, Kept{std::move(value), now + lifetime_});
    return ticket;
  }

  // Returns the value, once; nullopt if there is no such ticket, or if it was used or has expired.
  std::optional<Value> Use(const std::string& ticket, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_) {
    absl::MutexLock lock(&mutex_);
    const auto found = kept_.find(ticket);
    if (found == kept_.end()) return std::nullopt;
    Kept kept = std::move(found->second);
    kept_.erase(found);
    return kept.expires > now ? std::optional<Value>(std::move(kept.value)) : std::nullopt;
  }

 private:
  static constexpr std::size_t kMostTickets = 10'000;
  struct Kept {
    Value value;
    absl::Time expires;
  };

  // True if the ticket was used or has expired.
  bool IsOver(const std::string& ticket, absl::Time now) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    const auto found = kept_.find(ticket);
    return found == kept_.end() || found->second.expires <= now;
  }

  const absl::Duration lifetime_;
  absl::Mutex mutex_;
  std::map<std::string, Kept> kept_ ABSL_GUARDED_BY(mutex_);
  std::deque<std::string> order_ ABSL_GUARDED_BY(mutex_);  // oldest first, with some that were used
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_TICKETS_H_
