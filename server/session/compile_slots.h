// Decides which scene is compiled next: a bounded number at a time, with a share for each account.
#ifndef PHRENIC_SERVER_SESSION_COMPILE_SLOTS_H_
#define PHRENIC_SERVER_SESSION_COMPILE_SLOTS_H_

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::session {

// Two lanes, so that small scenes never wait for large ones. Within a lane, an account takes all slots but one, and the
// account that was served least recently comes first. Thread-safe. Models owns it; each caller waits on its own thread.
class CompileSlots {
 public:
  enum class Lane { kSmall, kLarge };

  // The numbers of slots of the lanes, each at least 1.
  CompileSlots(int small, int large) : capacity_{{Lane::kSmall, small}, {Lane::kLarge, large}} {}

  // Gives its slot back when it is destroyed. It calls the object, which must outlive it.
  using Slot = std::shared_ptr<void>;

  // Waits for a slot. CANCELLED once `cancelled` returns true, which is asked 20 times a second; RESOURCE_EXHAUSTED if
  // 8 scenes of the account, or 64 in all, wait already. An empty account counts as one account. A null `cancelled`
  // never cancels. The wait has no other limit.
  absl::StatusOr<Slot> Take(const std::string& account, Lane lane, const std::function<bool()>& cancelled)
      ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  struct Waiting {
    std::string account;
    Lane lane;
    bool operator==(const Waiting&) const = default;
  };
  using Queue = std::list<Waiting>;

  // RESOURCE_EXHAUSTED if no more may wait.
  absl::Status Enter(const std::string& account) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // True if this one is the next of its lane and its account has a slot left.
  bool IsNext(Queue::const_iterator one) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // True if the lane has a free slot, and the account has not all but one of them. With one slot, the account may take
  // it.
  bool MayRun(const Waiting& one) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the number of slots of this lane that the account has.
  int Running(const Waiting& one) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void GiveBack(const Waiting& one) ABSL_LOCKS_EXCLUDED(mutex_);

  const std::map<Lane, int> capacity_;
  mutable absl::Mutex mutex_;
  Queue waiting_ ABSL_GUARDED_BY(mutex_);                               // oldest first
  std::list<Waiting> running_ ABSL_GUARDED_BY(mutex_);                  // holders of a slot
  std::map<std::string, std::int64_t> served_ ABSL_GUARDED_BY(mutex_);  // accounts that wait or run: their last turn
  std::int64_t turns_ ABSL_GUARDED_BY(mutex_) = 0;                      // counts the slots given
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_COMPILE_SLOTS_H_
