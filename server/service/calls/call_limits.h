// How many calls, unread requests and threads the callers of a gRPC server may have.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_

#include <array>
#include <chrono>
#include <cstddef>

#include "server/service/calls/fair_share.h"
#include "server/service/calls/worker_threads.h"

namespace phrenic::service {

// Calls of different lanes do not wait for each other.
//
// CallTable::Add gives each method its lane. A lane has a number of threads, of which one caller may have a part; so a
// caller with many slow calls neither stops other callers nor its own short calls.
enum class Lane {
  kQuick,    // waits for no one; 8 threads, of one caller 4
  kSession,  // waits for a session's steps, or for the disk; 64 and 16
  kWork,     // computes for long: compiles, compares, checks, parses; 8 and 4
  kStream,   // writes at the speed of its client; 32 and 8
  kWatch,    // waits for changes; 64 and 16, and no call waits for a thread
};

// One per gRPC server. gRPC's own threads, of which there are few, only admit calls and read requests; every handler
// runs on a thread of its lane. Thread-safe.
//
// It outlives the gRPC server and its calls. A server in a cluster has a second one, for the calls that it forwards.
class CallLimits {
 public:
  // `max_calls` is the number of calls and streams in flight of one caller. All callers together have four times as
  // many. Of one caller, a quarter of `max_calls` may wait for a thread of each lane but kWatch. `request_time` is that
  // of --idle-seconds, `max_message` the size of the largest request [bytes].
  CallLimits(int max_calls, std::chrono::milliseconds request_time, std::size_t max_message);

  // Calls and streams in flight: of callers with an account or a link, and of the others. IncomingCall takes a place
  // when it has the headers, and holds it until the call is done. RESOURCE_EXHAUSTED if all are held. Callers of the
  // second kind have 1/16 as many places, each of them and together.
  FairShare& in_flight(bool known) { return known ? in_flight_ : unknown_; }
  // Requests that are being read, 24 in all and 4 of one caller; conversations whose client is to send a further one,
  // 64 and 16. A place may cost the memory of the largest request. Up to `max_calls` requests of a caller wait to be
  // read; conversations do not wait and end with RESOURCE_EXHAUSTED.
  FairShare& unread() { return unread_; }
  FairShare& conversations() { return conversations_; }
  // Large requests that were read and are not answered, so that a caller does not pile them up: one of the largest size
  // has four places (PlacesOf). 128 places, 32 of one caller; a request does not wait for a place.
  FairShare& requests() { return requests_; }
  // Returns the places of a request of so many bytes. None up to 64 KiB.
  std::size_t PlacesOf(std::size_t request) const;
  // Large replies that their clients have not read. Large means more than 64 KiB (ServedCall::Reply); each has a place
  // for every 4 MiB. 128 places, 64 of one caller; a reply does not wait for a place.
  FairShare& replies() { return replies_; }
  // A call holds its place while its handler runs.
  FairShare& lane(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  // Has as many threads as the lanes have places, so that a call with a place does not wait for a thread.
  WorkerThreads& threads() { return threads_; }
  // Timeout of a request, from its place in unread() to its last byte.
  std::chrono::milliseconds request_time() const { return request_time_; }

 private:
  const std::chrono::milliseconds request_time_;
  const std::size_t bytes_of_place_;  // of a request
  FairShare in_flight_, unknown_, unread_, conversations_, requests_, replies_;
  std::array<FairShare, 5> lanes_;  // by Lane
  WorkerThreads threads_;           // last: its destructor waits for handlers, which hold places of the others
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_CALL_LIMITS_H_
