// The server side of one WatchFrames stream: writes the viewer's newest message, one at a time, without blocking.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_
#define PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>

#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/served_call.h"
#include "server/session/session.h"
#include "server/stream/viewer.h"

namespace phrenic::service {

// Thread-safe: gRPC's threads and the publisher's thread call it. The call keeps it alive until OnDone; a publisher
// that wakes it at that moment holds a reference of its own.
//
// At most one write is in progress. Each event (a new message, a completed write, a cancellation) calls Pump, which
// does the next thing on the thread of the event. A slow client delays no other, because its viewer drops frames. The
// stream ends with CANCELLED, with PERMISSION_DENIED, or with the reason for which the publisher ended the viewer.
class WatchReactor final : public StreamEvents, public std::enable_shared_from_this<WatchReactor> {
 public:
  // The call outlives the stream. Make it in a shared pointer.
  explicit WatchReactor(ServedCall& call) : call_(call) {}

  // What FrameService attaches to a stream; released when it ends. may_see runs under the reactor's lock, so it must
  // not call the reactor.
  struct Subscription {
    std::shared_ptr<void> seats;                  // of the viewer, given back when it is destroyed
    std::function<bool()> may_see;                // checked before each message; null: always allowed
    std::function<void(std::size_t bytes)> sent;  // called with the size of each message
  };

  // Starts the stream, which ends with PERMISSION_DENIED when may_see becomes false. Call it once, by a shared pointer.
  // The first message may be written before it returns. The stream keeps the session alive.
  // Errors: the publisher's, if it does not accept the viewer; the stream then has not started.
  absl::Status Watch(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                     Subscription subscription);

  // Reactions, on gRPC's threads. OnDone removes the viewer from the publisher and releases the session.
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override;

 private:
  // The next operation: a write, a finish, or none.
  struct Next {
    stream::Bytes write = nullptr;
    std::optional<grpc::Status> finish = std::nullopt;
  };

  // Decides what to do and marks it as begun, so that only the calling thread does it.
  Next TakeNext() ABSL_LOCKS_EXCLUDED(mutex_);
  // Starts the next write or finishes the stream, unless a write is in progress. Does not block.
  void Pump() ABSL_LOCKS_EXCLUDED(mutex_);

  ServedCall& call_;  // until it is finished
  // Not held while gRPC is called, which may run the next reaction at once.
  absl::Mutex mutex_;
  std::shared_ptr<session::Session> session_ ABSL_GUARDED_BY(mutex_);  // until OnDone
  std::shared_ptr<stream::Viewer> viewer_ ABSL_GUARDED_BY(mutex_);     // null before Watch and after OnDone
  Subscription subscription_;                                          // set before viewer_
  bool writing_ ABSL_GUARDED_BY(mutex_) = false;                       // a write is in progress
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;                     // by the client, or a write has failed
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;                      // nothing is to be done any more
  grpc::ByteBuffer buffer_;  // owned by the thread that set writing_, until the write is done
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_REACTOR_H_
