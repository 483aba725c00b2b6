// How many calls, unread requests and threads the callers of a gRPC server may have.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_

#include <array>
#include <chrono>

#include "server/service/calls/fair_share.h"
#include "server/service/calls/worker_threads.h"

namespace phrenic::service {

// Calls of different lanes do not wait for each other.
enum class Lane {
  kQuick,    // waits for no one
  kSession,  // waits for a session's steps, or for the disk
  kWork,     // computes for long: compiles, compares, checks, parses
  kStream,   // writes at the speed of its client
  kWatch,    // waits for changes
};

// One per gRPC server. gRPC's own threads, of which there are few, only admit calls and read requests; every handler
// runs on a thread of its lane. Thread-safe.
class CallLimits {
 public:
  // `max_calls` is the number of calls and streams in flight of one caller.
  CallLimits(int max_calls, std::chrono::milliseconds request_time);

  // Calls and streams in flight: of callers with an account or a link, and of the others.
  FairShare& in_flight(bool known) { return known ? in_flight_ : unknown_; }
  // Requests that are being read; conversations whose client is to send a further one.
  FairShare& unread() { return unread_; }
  FairShare& conversations() { return conversations_; }
  // Large replies that their clients have not read.
  FairShare& replies() { return replies_; }
  FairShare& lane(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  WorkerThreads& threads() { return threads_; }
  // Timeout of a request, from its headers to its end.
  std::chrono::milliseconds request_time() const { return request_time_; }

 private:
  const std::chrono::milliseconds request_time_;
  FairShare in_flight_, unknown_, unread_, conversations_, replies_;
  std::array<FairShare, 5> lanes_;
  WorkerThreads threads_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_
