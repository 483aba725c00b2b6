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
#include "server/service/routing/session_router.h"
#include "server/service/routing/upstream_call.h"

namespace phrenic::service {

// Reads one request message, since Phrenic has no client-streaming methods, and writes any number of responses. Reads
// the next response from upstream after the previous one is written, so that a slow client exerts back-pressure.
//
// Errors: INVALID_ARGUMENT without a request; UNAVAILABLE if the session's server does not answer; else the status of
// the target. gRPC's threads call it; it deletes itself after OnDone.
class ForwardedCall final : public IncomingCall {
 public:
  // `rule` as in IncomingCall::Begin.
  static ForwardedCall* Make(SessionRouter& router, AccessGuard& guard, CallLimits& limits, const access::Rule* rule,
                             grpc::GenericCallbackServerContext& context);

  void OnWriteDone(bool ok) override;
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override;

 private:
  ForwardedCall(SessionRouter& router, AccessGuard& guard, CallLimits& limits,
                grpc::GenericCallbackServerContext& context);
  void OnRequest() override;
  // Finds the call's targets, on a thread of the limits, since Redis may have to be asked.
  void FindRoute();
  std::shared_ptr<ForwardedCall> self() { return std::static_pointer_cast<ForwardedCall>(shared_from_this()); }
  UpstreamCall::Request RequestTo(const SessionRouter::Target& target);
  std::shared_ptr<UpstreamCall> upstream() const ABSL_LOCKS_EXCLUDED(mutex_);

  // Calls the target with index target_.
  void CallTarget() ABSL_LOCKS_EXCLUDED(mutex_);
  bool WriteResponse(const grpc::ByteBuffer& message);
  // Finishes with the target's status, or tries the next target after NOT_FOUND.
  void OnUpstreamDone(const grpc::Status& status);

  // Calls all targets at once; OnFanOutDone merges the responses when all have ended.
  void FanOut() ABSL_LOCKS_EXCLUDED(mutex_);
  void OnFanOutDone(std::size_t index, const grpc::Status& status) ABSL_LOCKS_EXCLUDED(mutex_);

  SessionRouter& router_;
  const std::string method_, peer_;
  const SessionRouter::Metadata metadata_;
  grpc::ByteBuffer outgoing_;
  SessionRouter::Route route_;
  std::size_t target_ = 0;     // index of the route's current target
  bool responded_ = false;     // a response was forwarded to the client
  grpc::Status first_status_;  // of the first target; returned if no target finds the resource

  mutable absl::Mutex mutex_;
  std::shared_ptr<UpstreamCall> upstream_ ABSL_GUARDED_BY(mutex_);
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<grpc::ByteBuffer> responses_ ABSL_GUARDED_BY(mutex_);  // of a fan-out, one per target
  std::size_t pending_ ABSL_GUARDED_BY(mutex_) = 0;                  // targets of a fan-out that have not ended
  grpc::Status local_status_ ABSL_GUARDED_BY(mutex_);                // of a fan-out's first target, this server
  bool any_ok_ ABSL_GUARDED_BY(mutex_) = false;                      // a target of a fan-out has succeeded
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_
