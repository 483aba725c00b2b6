#include "server/service/routing/forwarded_call.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/service/calls/peer.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

// For the others' parts of a list: whoever takes longer is left out.
constexpr std::chrono::seconds kListPatience(2);

}  // namespace

ForwardedCall::ForwardedCall(SessionRouter& router, grpc::GenericCallbackServerContext& context)
    : router_(router),
      context_(context),
      method_(context.method()),
      peer_(PeerOf(context).empty() ? "unknown" : PeerOf(context)),
      metadata_(SessionRouter::MetadataOf(context)) {}

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
  if (route_.all) return Gather();
  Try();
}

UpstreamCall::Request ForwardedCall::RequestTo(const SessionRouter::Target& target) const {
  return {method_, request_, router_.MetadataFor(target, metadata_, peer_), context_.deadline()};
}

std::shared_ptr<UpstreamCall> ForwardedCall::upstream() const {
  absl::MutexLock lock(&mutex_);
  return upstream_;
}

void ForwardedCall::Try() {
  const SessionRouter::Target& target = route_.targets[tried_];
  if (!target.address.empty()) router_.CountForwarded();
  const auto way = UpstreamCall::Make(
      RequestTo(target),
      {.message = [self = shared_from_this()](const grpc::ByteBuffer& message) { return self->Pass(message); },
       .done = [self = shared_from_this()](const grpc::Status& status) { self->Ended(status); }});
  {
    absl::MutexLock lock(&mutex_);
    upstream_ = way;
    if (cancelled_) upstream_->Cancel();
  }
  way->Start(*target.stub);
}

bool ForwardedCall::Pass(const grpc::ByteBuffer& message) {
  passed_ = true;
  outgoing_ = message;
  StartWrite(&outgoing_);
  return false;
}

void ForwardedCall::OnWriteDone(bool ok) {
  const auto way = upstream();
  if (way == nullptr) return;  // lists, which end with their answer
  if (!ok) way->Cancel();
  way->ReadNext();
}

void ForwardedCall::Ended(const grpc::Status& status) {
  const SessionRouter::Target& target = route_.targets[tried_];
  const bool missing = !passed_ && status.error_code() == grpc::StatusCode::NOT_FOUND;
  const bool silent = !passed_ && status.error_code() == grpc::StatusCode::UNAVAILABLE && !target.address.empty();
  if (silent) router_.NoteGone(route_);
  if (tried_ == 0) first_ = status;
  if ((missing || (silent && tried_ > 0)) && tried_ + 1 < route_.targets.size()) {
    ++tried_;
    return Try();
  }
  if (silent && tried_ == 0) {
    return Finish({grpc::StatusCode::UNAVAILABLE,
                   absl::StrCat("the server at ", target.address, " that has the session does not answer (",
                                status.error_message(), "); ask again in a moment")});
  }
  Finish(missing || (silent && tried_ > 0) ? first_ : status);
}

void ForwardedCall::OnCancel() {
  std::shared_ptr<UpstreamCall> way;
  {
    absl::MutexLock lock(&mutex_);
    cancelled_ = true;
    way = upstream_;
  }
  if (way != nullptr) way->Cancel();
}

void ForwardedCall::OnDone() {
  std::shared_ptr<ForwardedCall> self = std::move(self_);
  absl::MutexLock lock(&mutex_);
  upstream_ = nullptr;
}

void ForwardedCall::Gather() {
  {
    absl::MutexLock lock(&mutex_);
    awaited_ = route_.targets.size();
    answers_.resize(awaited_);
  }
  for (std::size_t i = 0; i < route_.targets.size(); ++i) {
    UpstreamCall::Request request = RequestTo(route_.targets[i]);
    if (i > 0) request.deadline = std::min(request.deadline, std::chrono::system_clock::now() + kListPatience);
    UpstreamCall::Make(std::move(request), {.message =
                                                [self = shared_from_this(), i](const grpc::ByteBuffer& message) {
                                                  absl::MutexLock lock(&self->mutex_);
                                                  self->answers_[i] = message;
                                                  return true;
                                                },
                                            .done = [self = shared_from_this(),
                                                     i](const grpc::Status& status) { self->Gathered(i, status); }})
        ->Start(*route_.targets[i].stub);
  }
}

void ForwardedCall::Gathered(std::size_t index, const grpc::Status& status) {
  grpc::Status own;
  {
    absl::MutexLock lock(&mutex_);
    if (index == 0) own_ = status;
    if (!status.ok()) answers_[index].Clear();
    if (--awaited_ > 0) return;
    own = own_;
  }
  AnswerTogether(own);
}

void ForwardedCall::AnswerTogether(const grpc::Status& own) {
  if (!own.ok()) return Finish(own);
  std::vector<grpc::ByteBuffer> answers;
  {
    absl::MutexLock lock(&mutex_);
    answers.swap(answers_);
  }
  outgoing_ = Together(method_, request_, answers);
  StartWriteAndFinish(&outgoing_, {}, grpc::Status::OK);
}

}  // namespace phrenic::service
