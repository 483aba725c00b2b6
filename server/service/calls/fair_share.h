// Shares a limited number of places among callers, so that none takes them all.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_FAIR_SHARE_H_
#define PHRENIC_SERVER_SERVICE_CALLS_FAIR_SHARE_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::service {

// A caller is named by a key (AccessGuard::KeyOf). The empty key is this process itself, which has no limit of its own.
// Callers that wait get places in turn, whatever the number that each of them waits for. Thread-safe.
//
// What has a place depends on the use: a call in flight, a running handler, a comparison, a viewer. A caller's own
// entries get places in the order of Enter; a caller that has reached its own limit is passed over until it gives a
// place back.
class FairShare {
 public:
  struct Limits {
    std::string what;           // "comparisons"; the errors say it
    std::string setting;        // "--max-exports"; the errors name it
    int in_all = 1;             // places
    int of_caller = 1;          // places of one caller
    int waiting_of_caller = 0;  // that may wait for a place
  };
  // Has a place as long as it exists. The FairShare outlives it. Copies hold the same place, which is given back with
  // the last of them, on the thread that destroys it. That thread then runs the callbacks of those who get a place.
  using Hold = std::shared_ptr<void>;
  // Called at most once, without the lock, so it may call Take and Enter.
  using Granted = std::function<void(Hold hold)>;

  explicit FairShare(Limits limits) : limits_(std::move(limits)) {}

  // Takes a place at once. RESOURCE_EXHAUSTED, with the limit and its setting, if all are taken for this caller. Never
  // waits.
  absl::StatusOr<Hold> Take(const std::string& caller) ABSL_LOCKS_EXCLUDED(mutex_);
  // Calls `granted` with a place: now, or later on a thread that gives one back; it must return soon. Returns a ticket
  // for Withdraw. RESOURCE_EXHAUSTED if too many of this caller wait. `granted` may run before Enter returns. Tickets
  // differ and are never 0.
  absl::StatusOr<std::uint64_t> Enter(const std::string& caller, Granted granted) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns true if the ticket was still waiting; `granted` is then never called. Returns false if `granted` was
  // called, or is about to be.
  bool Withdraw(const std::string& caller, std::uint64_t ticket) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // One call of Enter that has no place yet.
  struct Waiting {
    std::uint64_t ticket;
    Granted granted;
  };
  // The places of a caller, and its entries in the order of Enter.
  struct Caller {
    int held = 0;
    std::deque<Waiting> waiting;
  };

  // True if one more place may be given to the caller; the empty name has only the limit of all.
  bool HasRoom(const std::string& name, const Caller& caller) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Forgets a caller who neither has nor waits for a place.
  void Tidy(const std::string& name) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Takes the next waiting entry whose caller has room, and counts its place; null if no caller has room.
  Granted TakeNext(std::string& caller) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Returns the holder of a place that is counted already. It refers to this object.
  Hold MakeHold(const std::string& caller);
  // Gives a place back, then grants it to the next who waits.
  void Release(const std::string& caller) ABSL_LOCKS_EXCLUDED(mutex_);
  // Grants places to those who wait, as long as there are any.
  void Grant() ABSL_LOCKS_EXCLUDED(mutex_);

  const Limits limits_;
  absl::Mutex mutex_;
  int held_ ABSL_GUARDED_BY(mutex_) = 0;                           // of all callers
  std::uint64_t tickets_ ABSL_GUARDED_BY(mutex_) = 0;              // given so far
  std::map<std::string, Caller> callers_ ABSL_GUARDED_BY(mutex_);  // that have or wait for a place
  std::deque<std::string> turns_ ABSL_GUARDED_BY(mutex_);          // callers that wait, the next one first
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_FAIR_SHARE_H_
