#include "server/service/calls/served_call.h"

#include <algorithm>
#include <utility>

#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

constexpr absl::Duration kStall = absl::Minutes(1);  // for which a client may read nothing

constexpr std::size_t kLargeReply = 64 << 10;   // [bytes]
constexpr std::size_t kBytesOfPlace = 4 << 20;  // of a large reply, for each of its places

}  // namespace

ServedCall* ServedCall::Make(const Method* method, AccessGuard& guard, CallLimits& limits,
                             grpc::GenericCallbackServerContext& context) {
  const std::shared_ptr<ServedCall> call(new ServedCall(method, guard, limits, context));
  call->Begin(method == nullptr ? nullptr : method->rule);
  return call.get();
}

void ServedCall::OnRequest() {
  const auto self = std::static_pointer_cast<ServedCall>(shared_from_this());
  Await(limits().lane(method_->lane), [self](FairShare::Hold hold) {
    self->limits().threads().Post([self, hold = std::move(hold)] { self->Run(); });
  });
}

void ServedCall::Run() {
  if (context().IsCancelled()) return FinishOnce(grpc::Status::CANCELLED);
  const std::optional<grpc::Status> status = method_->handler(*this);
  if (status.has_value()) return FinishOnce(*status);
  if (method_->conversation) ReadNext();
}

bool ServedCall::Write(const grpc::ByteBuffer& message) {
  if (absl::Status reserved = Reserve(message.Length()); !reserved.ok()) {
    FinishOnce(ToGrpc(reserved));
    return false;
  }
  {
    absl::MutexLock lock(&mutex_);
    if (context().IsCancelled()) return false;
    writing_ = true;
  }
  outgoing_ = message;
  StartWrite(&outgoing_);
  const auto done = [this] {
    mutex_.AssertHeld();
    return !writing_;
  };
  absl::MutexLock lock(&mutex_);
  if (mutex_.AwaitWithTimeout(absl::Condition(&done), kStall)) return written_;
  context().TryCancel();  // the write then fails
  mutex_.Await(absl::Condition(&done));
  return false;
}

absl::Status ServedCall::Reserve(std::size_t bytes) {
  const std::size_t places = bytes <= kLargeReply ? 0 : (bytes - kLargeReply + kBytesOfPlace - 1) / kBytesOfPlace;
  while (reply_.size() < places) {
    auto place = limits().replies().Take(caller());
    if (!place.ok()) return place.status();
    reply_.push_back(*std::move(place));
  }
  return absl::OkStatus();
}

void ServedCall::Reply(const grpc::ByteBuffer& message) {
  if (absl::Status reserved = Reserve(message.Length()); !reserved.ok()) return FinishOnce(ToGrpc(reserved));
  outgoing_ = message;
  FinishOnce(outgoing_, grpc::Status::OK);
}

std::shared_ptr<StreamEvents> ServedCall::events() {
  absl::MutexLock lock(&mutex_);
  return events_;
}

void ServedCall::Continue(const std::shared_ptr<StreamEvents>& events) {
  {
    absl::MutexLock lock(&mutex_);
    events_ = events;
  }
  if (context().IsCancelled()) events->OnCancel();
}

void ServedCall::OnWriteDone(bool ok) {
  if (const auto stream = events(); stream != nullptr) return stream->OnWriteDone(ok);
  absl::MutexLock lock(&mutex_);
  writing_ = false;
  written_ = ok;
}

void ServedCall::OnCancel() {
  if (const auto stream = events(); stream != nullptr) return stream->OnCancel();
  IncomingCall::OnCancel();
}

void ServedCall::OnDone() {
  reply_.clear();
  if (const auto stream = events(); stream != nullptr) stream->OnDone();
  IncomingCall::OnDone();
}

}  // namespace phrenic::service
