// A call at a cluster's front, passed on to where its session is.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/support/byte_buffer.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/routing/session_router.h"
#include "server/service/routing/upstream_call.h"

namespace phrenic::service {

// gRPC's threads call. One message comes in: no method of Phrenic's has a stream of requests.
class ForwardedCall final : public grpc::ServerGenericBidiReactor, public std::enable_shared_from_this<ForwardedCall> {
 public:
  static ForwardedCall* Make(SessionRouter& router, grpc::GenericCallbackServerContext& context);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override;

 private:
  ForwardedCall(SessionRouter& router, grpc::GenericCallbackServerContext& context);
  UpstreamCall::Request RequestTo(const SessionRouter::Target& target) const;
  std::shared_ptr<UpstreamCall> upstream() const ABSL_LOCKS_EXCLUDED(mutex_);
  // The next server that may have it.
  void Try() ABSL_LOCKS_EXCLUDED(mutex_);
  bool Pass(const grpc::ByteBuffer& message);
  void Ended(const grpc::Status& status);
  // All of them at once.
  void Gather();
  void Gathered(std::size_t index, const grpc::Status& status) ABSL_LOCKS_EXCLUDED(mutex_);
  void AnswerTogether(const grpc::Status& own);

  SessionRouter& router_;
  grpc::GenericCallbackServerContext& context_;
  const std::string method_, peer_;
  const SessionRouter::Metadata metadata_;
  std::shared_ptr<ForwardedCall> self_;  // gRPC's hold on it
  grpc::ByteBuffer request_, outgoing_;
  SessionRouter::Route route_;
  std::size_t tried_ = 0;  // of the route's targets
  bool passed_ = false;    // an answer
  grpc::Status first_;     // of the targets that did not find it

  mutable absl::Mutex mutex_;
  std::shared_ptr<UpstreamCall> upstream_ ABSL_GUARDED_BY(mutex_);
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<grpc::ByteBuffer> answers_ ABSL_GUARDED_BY(mutex_);  // of each target
  std::size_t awaited_ ABSL_GUARDED_BY(mutex_) = 0;
  grpc::Status own_ ABSL_GUARDED_BY(mutex_);  // of this server's answer
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_FORWARDED_CALL_H_
