// A WatchFrames stream whose messages do not go through gRPC: the web gateway takes them and writes them to a socket.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_CLAIMED_WATCH_H_
#define PHRENIC_SERVER_SERVICE_WATCH_CLAIMED_WATCH_H_

#include <functional>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/served_call.h"
#include "server/service/watch/watch_stream.h"

namespace phrenic::service {

class WatchClaims;

// Thread-safe. The gRPC call stays open as long as the stream: it has admitted the caller, it counts towards the limits
// of calls, its client may cancel it, its deadline may pass, and its end is that of the stream. It carries no message.
// The ServedCall and the taker share the object.
class ClaimedWatch final : public StreamEvents, public std::enable_shared_from_this<ClaimedWatch> {
 public:
  // The call outlives the stream. Make it in a shared pointer.
  explicit ClaimedWatch(ServedCall& call) : call_(call) {}

  // Starts the stream and gives it to the taker of the claim (WatchClaims); ends with CANCELLED if that has gone. Call
  // it once, by a shared pointer.
  // Errors: those of WatchStream::Join; the stream then has not started.
  absl::Status Start(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                     WatchStream::Subscription subscription, const std::string& key, WatchClaims& claims);

  // --- the taker ---
  // Sets what is called when Take may have a message: on the publisher's thread, and on those of acknowledgements. It
  // must not block or call this object. Null: nothing is called, also not on another thread, once this has returned.
  void set_ready(std::function<void()> ready) ABSL_LOCKS_EXCLUDED(ready_mutex_);
  // Returns the next message; null if none may be sent now. One message is in flight until NoteSent. Ends the call if
  // the stream has ended.
  stream::Bytes Take();
  // Notes that the message of the last Take was sent. Call Take afterwards.
  void NoteSent() { watch_.NoteSent(); }

  // Reactions, on gRPC's threads. OnDone removes the viewer from the publisher and releases the session.
  void OnWriteDone(bool /*ok*/) override {}
  void OnCancel() override;
  void OnDone() override { watch_.Leave(); }

 private:
  // Finishes the call, unless that was done: it may be gone afterwards.
  void Finish(const absl::Status& status) ABSL_LOCKS_EXCLUDED(finish_mutex_);
  void CallReady() ABSL_LOCKS_EXCLUDED(ready_mutex_);

  ServedCall& call_;  // until it is finished
  WatchStream watch_;
  absl::Mutex finish_mutex_;
  bool finished_ ABSL_GUARDED_BY(finish_mutex_) = false;
  absl::Mutex ready_mutex_;  // held while ready_ runs
  std::function<void()> ready_ ABSL_GUARDED_BY(ready_mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_CLAIMED_WATCH_H_
