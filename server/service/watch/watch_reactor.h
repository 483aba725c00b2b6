// A WatchFrames stream over gRPC: pumps one viewer's messages, without a thread of its own.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_WATCH_REACTOR_H_
#define PHRENIC_SERVER_SERVICE_WATCH_WATCH_REACTOR_H_

#include <grpcpp/support/byte_buffer.h>

#include <memory>

#include "absl/status/status.h"
#include "server/service/calls/served_call.h"
#include "server/service/watch/watch_stream.h"

namespace phrenic::service {

// Sends the messages of a WatchStream. gRPC's threads and the publisher's thread call it. The ServedCall keeps it alive
// until the stream has ended.
//
// At most one write is in progress. Each event (a new message, a completed write, a cancellation) calls Pump, which
// does the next thing on the thread of the event.
class WatchReactor final : public StreamEvents, public std::enable_shared_from_this<WatchReactor> {
 public:
  // The call outlives the stream. Make it in a shared pointer.
  explicit WatchReactor(ServedCall& call) : call_(call) {}

  // Starts the stream. Call it once, by a shared pointer. The first message may be written before it returns.
  // Errors: those of WatchStream::Join; the stream then has not started.
  absl::Status Start(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                     WatchStream::Subscription subscription);

  // Reactions, on gRPC's threads. OnDone removes the viewer from the publisher and releases the session.
  void OnWriteDone(bool ok) override;
  void OnCancel() override;
  void OnDone() override { watch_.Leave(); }

 private:
  // Starts the next write or finishes the stream, unless a write is in progress. Does not block.
  void Pump();

  ServedCall& call_;  // until it is finished
  WatchStream watch_;
  grpc::ByteBuffer buffer_;  // owned by the thread that took the message, until the write is done
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_WATCH_REACTOR_H_
