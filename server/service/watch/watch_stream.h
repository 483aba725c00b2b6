// The messages of one viewer of a session: which is next, and when and why they end.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_WATCH_STREAM_H_
#define PHRENIC_SERVER_SERVICE_WATCH_WATCH_STREAM_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "server/session/session.h"
#include "server/stream/viewer.h"

namespace phrenic::service {

// Thread-safe. WatchReactor sends the messages over gRPC, ClaimedWatch gives them to the web gateway; so access, flow
// control and the end of the stream are the same both ways. One message is in flight at a time. A slow client delays no
// other, because its viewer drops frames. The stream ends with CANCELLED, with PERMISSION_DENIED, or with the reason
// for which the publisher ended the viewer.
class WatchStream {
 public:
  // What FrameService attaches to a stream; released by Leave. The functions run under the lock, so they must not call
  // the watch.
  struct Subscription {
    std::shared_ptr<void> seats = nullptr;                  // of the viewer, given back when it is destroyed
    std::function<bool()> may_see = nullptr;                // checked before each message; null: always allowed
    std::function<void(std::size_t bytes)> sent = nullptr;  // called with the size of each message
  };
  // The next thing to do: send a message, end the stream, or, without both, nothing.
  struct Next {
    stream::Bytes message = nullptr;
    std::optional<absl::Status> end = std::nullopt;
  };

  // Adds the viewer. `ready` is called when Take may have something, as `wake` of Publisher::Join, possibly before Join
  // returns. The watch keeps the session alive until Leave. Call it once.
  // Errors: the publisher's, if it does not accept the viewer.
  absl::Status Join(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                    Subscription subscription, std::function<void()> ready) ABSL_LOCKS_EXCLUDED(mutex_);
  // From now on Take returns messages.
  void Begin() ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns what to do, each message and the end to one caller only. Nothing before Begin, after the end, and while a
  // message is in flight.
  Next Take() ABSL_LOCKS_EXCLUDED(mutex_);
  // Notes that the message of the last Take was sent. Call Take afterwards.
  void NoteSent() ABSL_LOCKS_EXCLUDED(mutex_);
  // Notes that the client is gone: the next Take returns the end.
  void Cancel() ABSL_LOCKS_EXCLUDED(mutex_);
  // Removes the viewer from the publisher, and releases session and subscription. Idempotent.
  void Leave() ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  absl::Mutex mutex_;
  std::shared_ptr<session::Session> session_ ABSL_GUARDED_BY(mutex_);  // null before Join and after Leave
  std::shared_ptr<stream::Viewer> viewer_ ABSL_GUARDED_BY(mutex_);     // the same
  Subscription subscription_ ABSL_GUARDED_BY(mutex_);
  bool begun_ ABSL_GUARDED_BY(mutex_) = false;
  bool in_flight_ ABSL_GUARDED_BY(mutex_) = false;  // a message was taken and is not sent
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;
  bool ended_ ABSL_GUARDED_BY(mutex_) = false;  // Take has returned the end
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_WATCH_STREAM_H_
