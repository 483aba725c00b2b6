#include "server/service/watch_reactor.h"

#include <grpcpp/support/slice.h>

#include <utility>

#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

// Returns a buffer that shares the bytes and keeps a reference to them.
grpc::ByteBuffer Share(const stream::Bytes& bytes) {
  auto* reference = new stream::Bytes(bytes);
  const grpc::Slice slice(
      const_cast<char*>(bytes->data()), bytes->size(),
      [](void* bytes_reference) { delete static_cast<stream::Bytes*>(bytes_reference); }, reference);
  return grpc::ByteBuffer(&slice, 1);
}

}  // namespace

absl::Status WatchReactor::Watch(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                                 Subscription subscription) {
  subscription_ = std::move(subscription);
  auto viewer = session->publisher().Join(options, [weak = weak_from_this()] {
    if (const auto reactor = weak.lock()) reactor->Pump();
  });
  if (!viewer.ok()) return viewer.status();
  call_.Continue(shared_from_this());  // before the first write
  {
    absl::MutexLock lock(&mutex_);
    session_ = std::move(session);
    viewer_ = *std::move(viewer);
  }
  Pump();
  return absl::OkStatus();
}

WatchReactor::Next WatchReactor::TakeNext() {
  absl::MutexLock lock(&mutex_);
  if (viewer_ == nullptr || writing_ || finished_) return {};
  std::optional<absl::Status> ended = cancelled_ ? absl::CancelledError() : viewer_->ended();
  if (!ended.has_value() && subscription_.may_see && !subscription_.may_see()) {
    ended = absl::PermissionDeniedError("authorization: you may no longer watch this session; ask its owner");
  }
  if (ended.has_value()) {
    finished_ = true;
    return {.finish = ToGrpc(*ended)};
  }
  Next next;
  next.write = viewer_->Take(absl::Now());
  writing_ = next.write != nullptr;
  return next;
}

// Calls StartWrite and FinishOnce without the lock, because gRPC may run the reaction at once. TakeNext gives each
// operation to one thread only.
void WatchReactor::Pump() {
  const Next next = TakeNext();
  if (next.finish.has_value()) {
    call_.FinishOnce(*next.finish);
  } else if (next.write != nullptr) {
    if (subscription_.sent) subscription_.sent(next.write->size());
    buffer_ = Share(next.write);
    call_.StartWrite(&buffer_);
  }
}

void WatchReactor::OnWriteDone(bool ok) {
  {
    absl::MutexLock lock(&mutex_);
    writing_ = false;
    if (!ok) cancelled_ = true;
  }
  Pump();
}

void WatchReactor::OnCancel() {
  {
    absl::MutexLock lock(&mutex_);
    cancelled_ = true;
  }
  Pump();
}

void WatchReactor::OnDone() {
  // Releases the session here: a publisher that wakes this reactor must not destroy its own session.
  std::shared_ptr<session::Session> session;
  std::shared_ptr<stream::Viewer> viewer;
  {
    absl::MutexLock lock(&mutex_);
    session = std::move(session_);
    viewer = std::move(viewer_);
  }
  if (session != nullptr) session->publisher().Leave(viewer);
}

}  // namespace phrenic::service
