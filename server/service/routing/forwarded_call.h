// One client call to a cluster's server, forwarded to the targets that SessionRouter chooses.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_

#include <grpcpp/support/byte_buffer.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/incoming_call.h"
#include "server/service/calls/served_call.h"
#include "server/service/routing/session_router.h"
#include "server/service/routing/upstream_call.h"

namespace phrenic::service {

// Reads a request and writes any number of responses. Reads the next response from upstream after the previous one is
// written, so that a slow client exerts back-pressure. Each request of a conversation is a call of its own to the
// target: when that has ended with OK, the next request is read.
//
// The request is read first; then FindRoute runs on a thread of the limits, which is free again when it returns. The
// handlers of the upstream calls run on gRPC's threads, one at a time unless the call fans out. Members without a guard
// belong to that sequence. The router outlives the call.
//
// Errors: INVALID_ARGUMENT without a request; UNAVAILABLE if the session's server does not answer; else the status of
// the target. gRPC's threads call it; it deletes itself after OnDone.
class ForwardedCall final : public IncomingCall {
 public:
  // `method` as in ServedCall::Make. The call owns itself, and may be done before Make returns: the pointer is for
  // gRPC alone.
  static ForwardedCall* Make(SessionRouter& router, AccessGuard& guard, CallLimits& limits, const Method* method,
                             grpc::GenericCallbackServerContext& context);

  // Reactions, on gRPC's threads. OnWriteDone reads on, and cancels the upstream call if the client is gone. OnCancel
  // cancels the upstream calls.
  void OnWriteDone(bool ok) override;
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override;

 private:
  ForwardedCall(SessionRouter& router, AccessGuard& guard, CallLimits& limits, const Method* method,
                grpc::GenericCallbackServerContext& context);
  // Waits for a place in Lane::kQuick.
  void OnRequest() override;
  // Finds the call's targets, on a thread of the limits, since Redis may have to be asked. The errors of
  // SessionRouter::Find end the call.
  void FindRoute();
  std::shared_ptr<ForwardedCall> self() { return std::static_pointer_cast<ForwardedCall>(shared_from_this()); }
  // Returns the client's request and deadline with the metadata for the target. Shares the bytes of the request.
  UpstreamCall::Request RequestTo(const SessionRouter::Target& target);
  // Returns null before the first target, in a fan-out, and after OnDone.
  std::shared_ptr<UpstreamCall> upstream() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Makes `call` one of those that OnCancel cancels, and starts it.
  void StartUpstream(const std::shared_ptr<UpstreamCall>& call, grpc::GenericStub& stub) ABSL_LOCKS_EXCLUDED(mutex_);

  // Calls the target with index target_.
  void CallTarget() ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns false, so that the next response is read when this one is written.
  bool WriteResponse(const grpc::ByteBuffer& message);
  // Finishes with the target's status, or tries the next target: after NOT_FOUND, and after UNAVAILABLE of a target
  // other than the first. A target that has sent a response is the last.
  void OnUpstreamDone(const grpc::Status& status);

  // Calls all targets at once; OnFanOutDone merges the responses when all have ended. Other servers have 2 s, this one
  // the time of the client.
  void FanOut() ABSL_LOCKS_EXCLUDED(mutex_);
  // The status of this server decides, except that UNAUTHENTICATED counts as OK if another server knows the caller's
  // join link. The list lacks the entries of servers that fail.
  void OnFanOutDone(std::size_t index, const grpc::Status& status) ABSL_LOCKS_EXCLUDED(mutex_);

  SessionRouter& router_;
  const bool conversation_;
  const std::string method_, peer_;         // peer_ is the IP address; "unknown" where the transport has no address
  const SessionRouter::Metadata metadata_;  // of the client, as far as they are forwarded
  grpc::ByteBuffer outgoing_;               // of the write in progress
  SessionRouter::Route route_;              // of the last request
  std::size_t target_ = 0;                  // index of the route's current target
  bool responded_ = false;                  // a response was forwarded to the client
  grpc::Status first_status_;               // of the first target; returned if no target finds the resource

  mutable absl::Mutex mutex_;
  std::vector<std::shared_ptr<UpstreamCall>> upstream_ ABSL_GUARDED_BY(mutex_);  // to the current target; to all
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;                               // the client has gone
  std::vector<grpc::ByteBuffer> responses_ ABSL_GUARDED_BY(mutex_);              // of a fan-out, one per target
  std::size_t pending_ ABSL_GUARDED_BY(mutex_) = 0;    // targets of a fan-out that have not ended
  grpc::Status local_status_ ABSL_GUARDED_BY(mutex_);  // of a fan-out's first target, this server
  bool any_ok_ ABSL_GUARDED_BY(mutex_) = false;        // a target of a fan-out has succeeded
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_
