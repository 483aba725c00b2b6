#include "server/service/sample_reactor.h"

#include <chrono>
#include <utility>

#include "server/service/calls/messages.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

constexpr std::chrono::milliseconds kBetween(50);  // two messages

}  // namespace

void SampleReactor::Start() {
  call_.Continue(shared_from_this());
  Pump();
}

SampleReactor::Next SampleReactor::TakeNext() {
  absl::MutexLock lock(&mutex_);
  if (finished_ || !reader_.has_value()) return {};
  if (cancelled_) {
    finished_ = true;
    return {.finish = grpc::Status::CANCELLED};
  }
  if (busy_) return {};
  return TakeBatch();
}

SampleReactor::Next SampleReactor::TakeBatch() {
  absl::StatusOr<v1::ReadSamplesResponse> read =
      absl::PermissionDeniedError("authorization: you may no longer watch this session; ask its owner");
  if (!subscription_.may_see || subscription_.may_see()) read = reader_->Next();
  if (!read.ok()) {
    finished_ = true;
    return {.finish = ToGrpc(read.status())};
  }
  busy_ = true;
  more_ = read->more();
  const bool first = std::exchange(first_, false);  // sent even if empty: the client learns that it is connected
  if (!first && IsEmpty(read->batch())) return {.wait = true};
  v1::WatchSamplesResponse response;
  *response.mutable_batch() = std::move(*read->mutable_batch());
  buffer_ = Serialize(response);
  return {.write = true};
}

// Calls gRPC without the lock, because it may run the reaction at once. TakeNext gives each operation to one thread.
void SampleReactor::Pump() {
  const Next next = TakeNext();
  if (next.finish.has_value()) call_.FinishOnce(*next.finish);
  if (next.write) call_.StartWrite(&buffer_);
  if (next.wait) Wait();
}

// A new alarm for each wait: its callback must not be replaced while it runs.
void SampleReactor::Wait() {
  absl::MutexLock lock(&mutex_);
  alarm_ = std::make_unique<grpc::Alarm>();
  alarm_->Set(std::chrono::system_clock::now() + kBetween, [self = shared_from_this()](bool) {
    {
      absl::MutexLock inner(&self->mutex_);
      self->busy_ = false;
    }
    self->Pump();
  });
}

void SampleReactor::OnWriteDone(bool ok) {
  bool again = false;
  {
    absl::MutexLock lock(&mutex_);
    if (!ok) cancelled_ = true;
    again = more_ || cancelled_;
    if (again) busy_ = false;
  }
  if (again) {
    Pump();
  } else {
    Wait();
  }
}

void SampleReactor::OnCancel() {
  {
    absl::MutexLock lock(&mutex_);
    cancelled_ = true;
  }
  Pump();
}

void SampleReactor::OnDone() {
  std::optional<SampleReader> reader;
  Subscription subscription;
  {
    absl::MutexLock lock(&mutex_);
    std::swap(reader, reader_);
    std::swap(subscription, subscription_);
    alarm_ = nullptr;
  }
  if (reader.has_value()) reader->Keep(kKept);
}

}  // namespace phrenic::service
