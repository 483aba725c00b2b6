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
class IncomingCall : public grpc::ServerGenericBidiReactor, public std::enable_shared_from_this<IncomingCall> {
 public:
  IncomingCall(AccessGuard& guard, CallLimits& limits, grpc::GenericCallbackServerContext& context)
      : guard_(guard), limits_(limits), context_(context) {}

  // Admits the call by its headers, and reads the request. `rule` of its method; null: there is no such method. The
  // request of an open method is empty, and is not read. Call once, before gRPC gets the reactor.
  // Errors: UNIMPLEMENTED; UNAUTHENTICATED; RESOURCE_EXHAUSTED; DEADLINE_EXCEEDED if the request is not complete in
  // time.
  void Begin(const access::Rule* rule);

  grpc::GenericCallbackServerContext& context() { return context_; }

  void OnReadDone(bool ok) final;
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override;

 protected:
  // Called when request() is complete. Must not block.
  virtual void OnRequest() = 0;
  // Called instead if the client has ended a call without a further request.
  virtual void OnNoRequest() { FinishOnce({grpc::StatusCode::INVALID_ARGUMENT, "the call has no request"}); }

  grpc::ByteBuffer& request() { return request_; }
  const std::string& caller() const { return caller_; }
  CallLimits& limits() { return limits_; }
  // Reads the next request, within `time`, after waiting for a place in `share`.
  void Read(FairShare& share, std::chrono::milliseconds time) ABSL_LOCKS_EXCLUDED(mutex_);
  // Waits for a place in `share`. Finishes the call if too many wait, or if its
  // client goes away.
  void Await(FairShare& share, FairShare::Granted granted) ABSL_LOCKS_EXCLUDED(mutex_);
  // Finishes the call, unless that was done.
  void FinishOnce(const grpc::Status& status);
  // The same, after one message. `message` lives until OnDone.
  void FinishOnce(const grpc::ByteBuffer& message, const grpc::Status& status);

 private:
  void StartReading(std::chrono::milliseconds time);
  void Withdraw() ABSL_LOCKS_EXCLUDED(mutex_);

  AccessGuard& guard_;
  CallLimits& limits_;
  grpc::GenericCallbackServerContext& context_;
  std::shared_ptr<IncomingCall> self_;  // keeps the reactor alive until OnDone
  std::string caller_;
  grpc::ByteBuffer request_;
  FairShare::Hold in_flight_, reading_;
  std::optional<grpc::Alarm> alarm_;        // of the read
  std::atomic<bool> read_pending_ = false;  // neither complete nor expired
  std::atomic<bool> finished_ = false;
  std::atomic<bool> cancelled_ = false;  // can be read when the call, and its context with it, may be done

  absl::Mutex mutex_;
  std::uint64_t waits_ ABSL_GUARDED_BY(mutex_) = 0;       // calls of Await so far
  FairShare* awaited_ ABSL_GUARDED_BY(mutex_) = nullptr;  // by the last of them
  std::uint64_t ticket_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_INCOMING_CALL_H_
