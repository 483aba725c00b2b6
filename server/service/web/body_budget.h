// Bounds the memory that the bodies of unfinished requests occupy, over all connections and for each caller.
#ifndef PHRENIC_SERVER_SERVICE_WEB_BODY_BUDGET_H_
#define PHRENIC_SERVER_SERVICE_WEB_BODY_BUDGET_H_

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::service {

// Thread-safe.
//
// The gateway has one, of four longest messages in all and two for each caller, and it outlives the connections. Bodies
// up to 64 KiB are not counted (WebConnection). A request of known length takes its part before its body is read,
// others take theirs as they grow; no request waits for a part.
class BodyBudget {
 public:
  // The part of one request. It is given back by the destructor. Not thread-safe; the budget outlives it. A move swaps
  // the two shares.
  class Share {
   public:
    // Has no budget: it may only be assigned to, or destroyed.
    Share() = default;
    // Begins with no bytes. `caller` is an account, a join link or an IP address.
    Share(BodyBudget& budget, std::string caller) : budget_(&budget), caller_(std::move(caller)) {}
    Share(Share&& other) noexcept { *this = std::move(other); }
    Share& operator=(Share&& other) noexcept {
      std::swap(budget_, other.budget_);
      std::swap(caller_, other.caller_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    ~Share() {
      if (budget_ != nullptr) budget_->GiveBack(caller_, bytes_);
    }

    // Grows the share to `bytes` in total. False, with the share as it was, if that exceeds the caller's part or the
    // budget. Requires: the share has a budget. Never shrinks: a smaller number is true and changes nothing.
    bool GrowTo(std::size_t bytes) {
      if (bytes <= bytes_) return true;
      if (!budget_->Take(caller_, bytes - bytes_)) return false;
      bytes_ = bytes;
      return true;
    }

   private:
    BodyBudget* budget_ = nullptr;
    std::string caller_;
    std::size_t bytes_ = 0;
  };

  // `total` for all callers and `each` for one [bytes].
  BodyBudget(std::size_t total, std::size_t each) : total_(total), each_(each) {}

  // Returns the number of bytes in use.
  std::size_t used() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // False, and nothing taken, above either limit.
  bool Take(const std::string& caller, std::size_t bytes) ABSL_LOCKS_EXCLUDED(mutex_);
  // Requires: the caller has taken as many.
  void GiveBack(const std::string& caller, std::size_t bytes) ABSL_LOCKS_EXCLUDED(mutex_);

  const std::size_t total_, each_;
  mutable absl::Mutex mutex_;                                           // for both counts
  std::size_t used_ ABSL_GUARDED_BY(mutex_) = 0;                        // [bytes]
  std::map<std::string, std::size_t> callers_ ABSL_GUARDED_BY(mutex_);  // bytes of each caller that has any
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_BODY_BUDGET_H_
