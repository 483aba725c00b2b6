#include "server/service/watch/watch_reactor.h"

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

absl::Status WatchReactor::Start(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                                 WatchStream::Subscription subscription) {
  absl::Status joined = watch_.Join(std::move(session), options, std::move(subscription), [weak = weak_from_this()] {
    if (const auto reactor = weak.lock()) reactor->Pump();
  });
  if (!joined.ok()) return joined;
  call_.Continue(shared_from_this());  // before the first write
  watch_.Begin();
  Pump();
  return absl::OkStatus();
}

// No lock is held here, because gRPC may run the reaction at once. WatchStream::Take gives each message to one thread
// only.
void WatchReactor::Pump() {
  const WatchStream::Next next = watch_.Take();
  if (next.end.has_value()) {
    call_.FinishOnce(ToGrpc(*next.end));
  } else if (next.message != nullptr) {
    buffer_ = Share(next.message);
    call_.StartWrite(&buffer_);
  }
}

void WatchReactor::OnWriteDone(bool ok) {
  if (!ok) watch_.Cancel();
  watch_.NoteSent();
  Pump();
}

void WatchReactor::OnCancel() {
  watch_.Cancel();
  Pump();
}

}  // namespace phrenic::service
