// A call from outside, from its headers to the end of its request.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_INCOMING_CALL_H_
#define PHRENIC_SERVER_SERVICE_CALLS_INCOMING_CALL_H_

#include <grpcpp/alarm.h>
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/support/byte_buffer.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/access/rules.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_limits.h"

namespace phrenic::service {

// gRPC 1.51 reads the request of a registered method before the method's handler sees the call, at any speed and up to
// the largest size. A generic call is seen when its headers are there: this class refuses it then, if its caller has no
// account or too many calls, and reads few requests at a time, each within a time. gRPC's threads call it; it deletes
// itself after OnDone.
//
// ServedCall::Make and ForwardedCall::Make create it in a shared pointer. It holds itself from Begin to OnDone, and
// callbacks that wait hold it too, so it may live a little longer. Reactions run on gRPC's threads and must not block.
// The guard and the limits outlive it; the context is valid until OnDone.
class IncomingCall : public grpc::ServerGenericBidiReactor, public std::enable_shared_from_this<IncomingCall> {
 public:
  IncomingCall(AccessGuard& guard, CallLimits& limits, grpc::GenericCallbackServerContext& context)
      : guard_(guard), limits_(limits), context_(context) {}

  // Admits the call by its headers, and reads the request. `rule` of its method; null: there is no such method. The
  // request of an open method is empty, and is not read. Call once, before gRPC gets the reactor. May run OnRequest
  // before it returns.
  // Errors: UNIMPLEMENTED; UNAUTHENTICATED; RESOURCE_EXHAUSTED; DEADLINE_EXCEEDED if the request is not complete in
  // time.
  void Begin(const access::Rule* rule);

  // Not to be used after OnDone.
  grpc::GenericCallbackServerContext& context() { return context_; }

  // Reactions of grpc::ServerGenericBidiReactor: the read has ended, the client has gone away or its deadline has
  // passed, the call is over. An override of OnDone calls the base's last.
  void OnReadDone(bool ok) final;
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override;

 protected:
  // Called when request() is complete. Must not block. Runs on the thread that completed the read, and once for each
  // request of a conversation.
  virtual void OnRequest() = 0;

  // Returns the request that was read last. Not to be used while a read is in progress.
  grpc::ByteBuffer& request() { return request_; }
  // Returns the name under which the limits count this call (AccessGuard::KeyOf); one name for all callers without an
  // account or a link on a server with accounts.
  const std::string& caller() const { return caller_; }
  CallLimits& limits() { return limits_; }
  // Reads the next request of a conversation, for which the client has a minute. The call ends with OK if the client
  // has no further one. Requires: the call's last request was answered.
  void ReadNext();
  // Waits for a place in `share`. Finishes the call if too many wait, or if its client goes away. `granted` runs at
  // most once, at once or on a thread that gives a place back, and keeps the call alive. RESOURCE_EXHAUSTED or
  // CANCELLED ends the call. One wait at a time.
  void Await(FairShare& share, FairShare::Granted granted) ABSL_LOCKS_EXCLUDED(mutex_);
  // Finishes the call, unless that was done. Any thread may call it; the first call counts.
  void FinishOnce(const grpc::Status& status);
  // The same, after one message. `message` lives until OnDone.
  void FinishOnce(const grpc::ByteBuffer& message, const grpc::Status& status);

 private:
  // Reads a request, within `time`, after waiting for a place in `share`. The time begins with the place, which
  // is given back when the read ends. DEADLINE_EXCEEDED ends the call. Requires: no read is in progress.
  void Read(FairShare& share, std::chrono::milliseconds time) ABSL_LOCKS_EXCLUDED(mutex_);
  // Ends a call whose client has ended it without a further request: INVALID_ARGUMENT unless one was answered.
  void OnNoRequest();
  // Takes the places of CallLimits::requests that the request needs. RESOURCE_EXHAUSTED if there are too few.
  absl::Status TakePlaces();
  // Starts the read and the alarm that ends the call after `time`.
  void StartReading(std::chrono::milliseconds time);
  // Ends the present wait, and the call with CANCELLED. Does nothing if the place was granted.
  void Withdraw() ABSL_LOCKS_EXCLUDED(mutex_);

  AccessGuard& guard_;
  CallLimits& limits_;
  grpc::GenericCallbackServerContext& context_;
  std::shared_ptr<IncomingCall> self_;      // keeps the reactor alive until OnDone
  std::string caller_;                      // constant after Begin
  grpc::ByteBuffer request_;                // written by gRPC during a read
  FairShare::Hold in_flight_, reading_;     // of the whole call; of the read in progress
  std::vector<FairShare::Hold> places_;     // of a large request, until OnDone or the next read
  std::optional<grpc::Alarm> alarm_;        // of the read
  bool answered_ = false;                   // ReadNext was called: a conversation had a request
  std::atomic<bool> read_pending_ = false;  // neither complete nor expired
  std::atomic<bool> finished_ = false;      // FinishOnce was called
  std::atomic<bool> cancelled_ = false;     // can be read when the call, and its context with it, may be done

  // Guards the wait alone: OnCancel and the thread that waits may meet.
  absl::Mutex mutex_;
  std::uint64_t waits_ ABSL_GUARDED_BY(mutex_) = 0;       // calls of Await so far
  FairShare* awaited_ ABSL_GUARDED_BY(mutex_) = nullptr;  // by the last of them
  std::uint64_t ticket_ ABSL_GUARDED_BY(mutex_) = 0;      // of the wait in awaited_
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_INCOMING_CALL_H_
