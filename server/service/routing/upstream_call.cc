#include "server/service/routing/upstream_call.h"

#include <utility>

#include "server/service/calls/status.h"

namespace phrenic::service {

UpstreamCall::UpstreamCall(Request request, Handlers handlers)
    : request_(std::move(request)), handlers_(std::move(handlers)) {}

std::shared_ptr<UpstreamCall> UpstreamCall::Make(Request request, Handlers handlers) {
  std::shared_ptr<UpstreamCall> call(new UpstreamCall(std::move(request), std::move(handlers)));
  call->self_ = call;
  return call;
}

void UpstreamCall::Start(grpc::GenericStub& stub) {
  const absl::Status status = PrepareContext(request_.method, request_.metadata, context_);
  if (!status.ok()) return OnDone(ToGrpc(status));
  context_.set_deadline(request_.deadline);
  stub.PrepareBidiStreamingCall(&context_, request_.method, {}, this);
  AddHold();  // ReadNext starts reads outside of reactions; the read that fails releases the hold
  StartWriteLast(&request_.message, {});
  StartRead(&incoming_);
  StartCall();
}

void UpstreamCall::OnReadDone(bool ok) {
  if (!ok) return RemoveHold();
  if (handlers_.message(incoming_)) ReadNext();
}

void UpstreamCall::OnDone(const grpc::Status& status) {
  const std::shared_ptr<UpstreamCall> self = std::move(self_);
  const Handlers handlers = std::move(handlers_);
  handlers.done(status);
}

}  // namespace phrenic::service
