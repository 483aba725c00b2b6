#include "server/service/calls/incoming_call.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

constexpr std::chrono::milliseconds kConversationPause(60'000);  // between two requests

}  // namespace

void IncomingCall::Begin(const access::Rule* rule) {
  self_ = shared_from_this();
  if (rule == nullptr) {
    return FinishOnce({grpc::StatusCode::UNIMPLEMENTED, absl::StrCat("there is no method ", context_.method())});
  }
  const auto caller = guard_.AdmitHeaders(context_, *rule);
  if (!caller.ok()) return FinishOnce(ToGrpc(caller.status()));
  caller_ = guard_.KeyOf(*caller, context_);
  const bool known = guard_.IsKnown(*caller);
  auto in_flight = limits_.in_flight(known).Take(caller_);
  if (!in_flight.ok()) return FinishOnce(ToGrpc(in_flight.status()));
  if (!known) caller_ = "callers without an account";  // share the places of one
  in_flight_ = *std::move(in_flight);
  if (rule->open) {
    const grpc::Slice empty;
    request_ = grpc::ByteBuffer(&empty, 1);
    return OnRequest();
  }
  Read(limits_.unread(), limits_.request_time());
}

void IncomingCall::Read(FairShare& share, std::chrono::milliseconds time) {
  Await(share, [self = shared_from_this(), time](FairShare::Hold hold) {
    self->reading_ = std::move(hold);
    self->StartReading(time);
  });
}

void IncomingCall::ReadNext() {
  answered_ = true;
  Read(limits_.conversations(), kConversationPause);
}

void IncomingCall::OnNoRequest() {
  FinishOnce(answered_ ? grpc::Status::OK
                       : grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "the call has no request"));
}

void IncomingCall::StartReading(std::chrono::milliseconds time) {
  read_pending_ = true;
  alarm_.emplace();
  alarm_->Set(std::chrono::system_clock::now() + time, [weak = weak_from_this(), time](bool expired) {
    const auto self = expired ? weak.lock() : nullptr;
    if (self == nullptr || !self->read_pending_.exchange(false)) return;
    self->FinishOnce({grpc::StatusCode::DEADLINE_EXCEEDED,
                      absl::StrCat("the request was not complete after ", time.count() / 1000, " s (--idle-seconds)")});
  });
  StartRead(&request_);
}

void IncomingCall::OnReadDone(bool ok) {
  const bool in_time = read_pending_.exchange(false);
  alarm_->Cancel();
  reading_ = nullptr;
  if (!in_time) return;
  if (context_.IsCancelled()) return FinishOnce(grpc::Status::CANCELLED);
  if (!ok) return OnNoRequest();
  if (absl::Status taken = TakePlaces(); !taken.ok()) return FinishOnce(ToGrpc(taken));
  OnRequest();
}

absl::Status IncomingCall::TakePlaces() {
  places_.clear();
  const std::size_t places = limits_.PlacesOf(request_.Length());
  while (places_.size() < places) {
    auto place = limits_.requests().Take(caller_);
    if (!place.ok()) {
      request_.Clear();
      return place.status();
    }
    places_.push_back(*std::move(place));
  }
  return absl::OkStatus();
}

void IncomingCall::Await(FairShare& share, FairShare::Granted granted) {
  const std::shared_ptr<IncomingCall> self = shared_from_this();  // it may be done before Enter returns
  std::uint64_t wait = 0;
  {
    absl::MutexLock lock(&mutex_);
    wait = ++waits_;
    awaited_ = nullptr;
  }
  const auto ticket = share.Enter(caller_, std::move(granted));
  if (!ticket.ok()) return FinishOnce(ToGrpc(ticket.status()));
  {
    absl::MutexLock lock(&mutex_);
    if (waits_ != wait) return;  // it got its place, and waits for the next one
    awaited_ = &share;
    ticket_ = *ticket;
  }
  if (cancelled_) Withdraw();
}

void IncomingCall::Withdraw() {
  FairShare* awaited = nullptr;
  std::uint64_t ticket = 0;
  {
    absl::MutexLock lock(&mutex_);
    std::swap(awaited, awaited_);
    ticket = ticket_;
  }
  if (awaited != nullptr && awaited->Withdraw(caller_, ticket)) FinishOnce(grpc::Status::CANCELLED);
}

void IncomingCall::OnCancel() {
  cancelled_ = true;
  Withdraw();
}

void IncomingCall::FinishOnce(const grpc::Status& status) {
  if (!finished_.exchange(true)) Finish(status);
}

void IncomingCall::FinishOnce(const grpc::ByteBuffer& message, const grpc::Status& status) {
  if (!finished_.exchange(true)) StartWriteAndFinish(&message, grpc::WriteOptions(), status);
}

void IncomingCall::OnDone() {
  places_.clear();
  in_flight_ = nullptr;
  const std::shared_ptr<IncomingCall> self = std::move(self_);
}

}  // namespace phrenic::service
