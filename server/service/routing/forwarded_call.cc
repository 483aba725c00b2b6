#include "server/service/routing/forwarded_call.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/service/calls/peer.h"
#include "server/service/calls/status.h"
#include "server/service/routing/merge_responses.h"

namespace phrenic::service {
namespace {

// Deadline of the other servers in a fan-out; a list is returned without those that miss it.
constexpr std::chrono::seconds kFanOutTimeout(2);

}  // namespace

ForwardedCall::ForwardedCall(SessionRouter& router, grpc::GenericCallbackServerContext& context)
    : router_(router),
      context_(context),
      method_(context.method()),
      peer_(PeerOf(context).empty() ? "unknown" : PeerOf(context)),
      metadata_(SessionRouter::ForwardedMetadata(context)) {}

ForwardedCall* ForwardedCall::Make(SessionRouter& router, grpc::GenericCallbackServerContext& context) {
  std::shared_ptr<ForwardedCall> call(new ForwardedCall(router, context));
  call->self_ = call;
  call->StartRead(&call->request_);
  return call.get();
}

void ForwardedCall::OnReadDone(bool ok) {
  if (!ok) return Finish({grpc::StatusCode::INVALID_ARGUMENT, "the call has no request"});
  auto route = router_.Find(method_, metadata_, request_);
  if (!route.ok()) return Finish(ToGrpc(route.status()));
  route_ = *std::move(route);
  if (route_.fan_out) return FanOut();
  CallTarget();
}

UpstreamCall::Request ForwardedCall::RequestTo(const SessionRouter::Target& target) const {
  return {method_, request_, router_.MetadataFor(target, metadata_, peer_), DeadlineOf(context_)};
}

std::shared_ptr<UpstreamCall> ForwardedCall::upstream() const {
  absl::MutexLock lock(&mutex_);
  return upstream_;
}

void ForwardedCall::CallTarget() {
  const SessionRouter::Target& target = route_.targets[target_];
  if (!target.address.empty()) router_.CountForwarded();
  const auto call = UpstreamCall::Make(
      RequestTo(target),
      {.message = [self = shared_from_this()](const grpc::ByteBuffer& message) { return self->WriteResponse(message); },
       .done = [self = shared_from_this()](const grpc::Status& status) { self->OnUpstreamDone(status); }});
  {
    absl::MutexLock lock(&mutex_);
    upstream_ = call;
    if (cancelled_) upstream_->Cancel();
  }
  call->Start(*target.stub);
}

bool ForwardedCall::WriteResponse(const grpc::ByteBuffer& message) {
  responded_ = true;
  outgoing_ = message;
  StartWrite(&outgoing_);
  return false;
}

void ForwardedCall::OnWriteDone(bool ok) {
  const auto call = upstream();
  if (call == nullptr) return;  // a fan-out ends with its only write
  if (!ok) call->Cancel();
  call->ReadNext();
}

void ForwardedCall::OnUpstreamDone(const grpc::Status& status) {
  const SessionRouter::Target& target = route_.targets[target_];
  const bool first = target_ == 0;
  const bool missing = !responded_ && status.error_code() == grpc::StatusCode::NOT_FOUND;
  const bool unreachable =
      !responded_ && status.error_code() == grpc::StatusCode::UNAVAILABLE && !target.address.empty();
  if (unreachable) router_.ReportUnreachable(route_);
  if (first) first_status_ = status;
  if (first && unreachable) {
    return Finish({grpc::StatusCode::UNAVAILABLE,
                   absl::StrCat("the server at ", target.address, ", which has the session, does not answer (",
                                status.error_message(), "); try again in a moment")});
  }
  if (!missing && !unreachable) return Finish(status);
  if (target_ + 1 == route_.targets.size()) return Finish(first_status_);
  ++target_;
  CallTarget();
}

void ForwardedCall::OnCancel() {
  std::shared_ptr<UpstreamCall> call;
  {
    absl::MutexLock lock(&mutex_);
    cancelled_ = true;
    call = upstream_;
  }
  if (call != nullptr) call->Cancel();
}

void ForwardedCall::OnDone() {
  std::shared_ptr<ForwardedCall> self = std::move(self_);
  absl::MutexLock lock(&mutex_);
  upstream_ = nullptr;
}

void ForwardedCall::FanOut() {
  {
    absl::MutexLock lock(&mutex_);
    pending_ = route_.targets.size();
    responses_.resize(pending_);
  }
  for (std::size_t i = 0; i < route_.targets.size(); ++i) {
    UpstreamCall::Request request = RequestTo(route_.targets[i]);
    if (i > 0) request.deadline = std::min(request.deadline, std::chrono::system_clock::now() + kFanOutTimeout);
    const auto keep = [self = shared_from_this(), i](const grpc::ByteBuffer& message) {
      absl::MutexLock lock(&self->mutex_);
      self->responses_[i] = message;
      return true;
    };
    const auto done = [self = shared_from_this(), i](const grpc::Status& status) { self->OnFanOutDone(i, status); };
    UpstreamCall::Make(std::move(request), {.message = keep, .done = done})->Start(*route_.targets[i].stub);
  }
}

void ForwardedCall::OnFanOutDone(std::size_t index, const grpc::Status& status) {
  grpc::Status local_status;
  std::vector<grpc::ByteBuffer> responses;
  {
    absl::MutexLock lock(&mutex_);
    if (index == 0) local_status_ = status;
    if (status.ok()) any_ok_ = true;
    if (!status.ok()) responses_[index].Clear();
    if (--pending_ > 0) return;
    local_status = local_status_;
    // Only the server of a join link's session knows the link.
    if (any_ok_ && local_status.error_code() == grpc::StatusCode::UNAUTHENTICATED) local_status = grpc::Status::OK;
    responses.swap(responses_);
  }
  if (!local_status.ok()) return Finish(local_status);
  outgoing_ = MergeResponses(method_, request_, responses, router_.page_tokens());
  StartWriteAndFinish(&outgoing_, {}, grpc::Status::OK);
}

}  // namespace phrenic::service
