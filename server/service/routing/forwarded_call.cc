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

ForwardedCall::ForwardedCall(SessionRouter& router, AccessGuard& guard, CallLimits& limits, const Method* method,
                             grpc::GenericCallbackServerContext& context)
    : IncomingCall(guard, limits, context),
      router_(router),
      conversation_(method != nullptr && method->conversation),
      method_(context.method()),
      peer_(PeerOf(context).empty() ? "unknown" : PeerOf(context)),
      metadata_(SessionRouter::ForwardedMetadata(context)) {}

ForwardedCall* ForwardedCall::Make(SessionRouter& router, AccessGuard& guard, CallLimits& limits, const Method* method,
                                   grpc::GenericCallbackServerContext& context) {
  const std::shared_ptr<ForwardedCall> call(new ForwardedCall(router, guard, limits, method, context));
  call->Begin(method == nullptr ? nullptr : method->rule);
  return call.get();
}

void ForwardedCall::OnRequest() {
  Await(limits().lane(Lane::kQuick), [self = self()](FairShare::Hold hold) {
    self->limits().threads().Post([self, hold = std::move(hold)] { self->FindRoute(); });
  });
}

void ForwardedCall::FindRoute() {
  auto route = router_.Find(method_, metadata_, request());
  if (!route.ok()) return FinishOnce(ToGrpc(route.status()));
  route_ = *std::move(route);
  target_ = 0;
  responded_ = false;
  if (route_.fan_out) return FanOut();
  CallTarget();
}

UpstreamCall::Request ForwardedCall::RequestTo(const SessionRouter::Target& target) {
  return {method_, request(), router_.MetadataFor(target, metadata_, peer_), DeadlineOf(context())};
}

std::shared_ptr<UpstreamCall> ForwardedCall::upstream() const {
  absl::MutexLock lock(&mutex_);
  return upstream_.empty() || route_.fan_out ? nullptr : upstream_.back();
}

void ForwardedCall::StartUpstream(const std::shared_ptr<UpstreamCall>& call, grpc::GenericStub& stub) {
  {
    absl::MutexLock lock(&mutex_);
    if (!route_.fan_out) upstream_.clear();
    upstream_.push_back(call);
    if (cancelled_) call->Cancel();
  }
  call->Start(stub);
}

void ForwardedCall::CallTarget() {
  const SessionRouter::Target& target = route_.targets[target_];
  if (!target.address.empty()) router_.CountForwarded();
  const auto call = UpstreamCall::Make(
      RequestTo(target),
      {.message = [self = self()](const grpc::ByteBuffer& message) { return self->WriteResponse(message); },
       .done = [self = self()](const grpc::Status& status) { self->OnUpstreamDone(status); }});
  StartUpstream(call, *target.stub);
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
    return FinishOnce({grpc::StatusCode::UNAVAILABLE,
                       absl::StrCat("the server at ", target.address, ", which has the session, does not answer (",
                                    status.error_message(), "); try again in a moment")});
  }
  if (status.ok() && conversation_) return ReadNext();
  if (!missing && !unreachable) return FinishOnce(status);
  if (target_ + 1 == route_.targets.size()) return FinishOnce(first_status_);
  ++target_;
  CallTarget();
}

void ForwardedCall::OnCancel() {
  std::vector<std::shared_ptr<UpstreamCall>> calls;
  {
    absl::MutexLock lock(&mutex_);
    cancelled_ = true;
    calls = upstream_;
  }
  for (const auto& call : calls) call->Cancel();
  IncomingCall::OnCancel();
}

void ForwardedCall::OnDone() {
  {
    absl::MutexLock lock(&mutex_);
    upstream_.clear();
  }
  IncomingCall::OnDone();
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
    const auto keep = [self = self(), i](const grpc::ByteBuffer& message) {
      absl::MutexLock lock(&self->mutex_);
      self->responses_[i] = message;
      return true;
    };
    const auto done = [self = self(), i](const grpc::Status& status) { self->OnFanOutDone(i, status); };
    StartUpstream(UpstreamCall::Make(std::move(request), {.message = keep, .done = done}), *route_.targets[i].stub);
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
  if (!local_status.ok()) return FinishOnce(local_status);
  outgoing_ = MergeResponses(method_, request(), responses, router_.page_tokens());
  FinishOnce(outgoing_, grpc::Status::OK);
}

}  // namespace phrenic::service
