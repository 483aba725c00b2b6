// Work on large states, of which little runs at the same time.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_TURN_H_
#define PHRENIC_SERVER_SERVICE_CALLS_TURN_H_

#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/synchronization/notification.h"
#include "server/service/calls/fair_share.h"

namespace phrenic::service {

// A service has one for its reads that take long on a large model, so that many threads of a lane do not keep all cores
// from short calls: two at a time, one of a caller.
inline FairShare::Limits LargeReads() { return {"reads of large models", "--max-calls", 2, 1, 64}; }
// Reads of fewer bytes take no turn.
inline constexpr std::size_t kLargeRead = 1 << 20;

// Waits on the calling thread for a place in `share`; callers take turns. RESOURCE_EXHAUSTED if too many of the caller
// wait. Thread-safe.
inline absl::StatusOr<FairShare::Hold> AwaitTurn(FairShare& share, const std::string& caller) {
  struct Wait {
    absl::Notification granted;
    FairShare::Hold hold;
  };
  const auto wait = std::make_shared<Wait>();
  const auto ticket = share.Enter(caller, [wait](FairShare::Hold hold) {
    wait->hold = std::move(hold);
    wait->granted.Notify();
  });
  if (!ticket.ok()) return ticket.status();
  wait->granted.WaitForNotification();
  return std::move(wait->hold);
}

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_TURN_H_
