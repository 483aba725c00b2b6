// One viewer's mailbox: a slot for the newest frame, a slot for the newest camera, and a queue of status updates. A
// newer frame or camera replaces one that was not taken, so a slow viewer misses frames and delays no other; status
// updates are never dropped.
#ifndef PHRENIC_SERVER_STREAM_VIEWER_H_
#define PHRENIC_SERVER_STREAM_VIEWER_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"
#include "server/stream/credit.h"
#include "server/stream/frame_encoding.h"

namespace phrenic::stream {

// A serialized WatchFramesResponse, shared by all subscriptions. Immutable; null means that there is no message.
using Bytes = std::shared_ptr<const std::string>;

// A serialized status of the session. A later update of the same revision replaces an earlier one.
struct StatusUpdate {
  std::int64_t revision = 0;  // v1::Session.revision
  Bytes bytes;
};

// From WatchFramesRequest; constant while the viewer watches.
struct ViewerOptions {
  double max_fps = 0;  // most frames a second; 0: every frame
  FrameEncoding encoding = {};
  int max_unacked = 0;        // frames; 0: unlimited
  bool may_coarsen = false;   // if the connection is too slow
  std::string watch_id = {};  // names it in Acknowledge; empty: it does not acknowledge
};

// Thread-safe. The publisher puts messages; the reactor that serves the viewer takes them. Publisher::Join makes one;
// the publisher and the reactor share it. It has one frame and one camera at most, and kMaxUpdates updates.
class Viewer {
 public:
  // Calls `wake` after each put or acknowledgement, on the calling thread, without locks. Requires: `wake` does not
  // block.
  Viewer(const ViewerOptions& options, std::function<void()> wake)
      : options_(options),
        wake_(std::move(wake)),
        credit_({.window = options.max_unacked,
                 .bound_level = options.encoding.bound_level,
                 .may_coarsen = options.may_coarsen}) {}

  const ViewerOptions& options() const { return options_; }
  // Returns the encoding of the next frame. The error bound follows the flow control, the basis the last
  // acknowledgement.
  FrameEncoding encoding() const ABSL_LOCKS_EXCLUDED(mutex_);

  // Replaces a frame that was not taken, which counts as missed unless it has the same sequence number. Does nothing
  // after End.
  void PutFrame(std::int64_t sequence, Bytes frame, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns false if a frame may be sent now. Otherwise defers this frame, in place of any other, without encoding it.
  bool Defer(std::int64_t sequence, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // Queues an update. Ends a viewer with kMaxUpdates untaken updates with RESOURCE_EXHAUSTED. An update of the same
  // revision replaces the last one.
  void PutSession(const StatusUpdate& updates) ABSL_LOCKS_EXCLUDED(mutex_);
  // Replaces a camera that was not taken.
  void PutCamera(Bytes camera) ABSL_LOCKS_EXCLUDED(mutex_);
  // Ends the subscription; messages put before may still be taken. A frame that the window does not allow is dropped. A
  // second call has no effect.
  void End(absl::Status reason) ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns the next message: status updates and the camera before a frame, and a frame only if the window of
  // unacknowledged frames allows it. Null if no frame may be sent. A frame that is taken counts as sent at `now`.
  Bytes Take(absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // Records an acknowledgement and returns the resulting flow control. `basis_epoch` is that of the viewer's basis. All
  // frames up to `sequence` are acknowledged. The response has frames a second, bound [mm] and window; Publisher adds
  // the newest epoch.
  v1::AckFramesResponse Acknowledge(std::int64_t sequence, std::int64_t basis_epoch, absl::Time now)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // True if a deferred frame waits for this viewer.
  bool deferred() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the reason of End once all messages are taken. nullopt while the subscription goes on.
  std::optional<absl::Status> ended() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the number of frames that were replaced before they were taken.
  std::int64_t missed() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // Replaces the waiting frame; counts it as missed.
  void Wait(std::int64_t sequence, absl::Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const ViewerOptions options_;
  const std::function<void()> wake_;
  mutable absl::Mutex mutex_;
  Credit credit_ ABSL_GUARDED_BY(mutex_);
  Bytes frame_ ABSL_GUARDED_BY(mutex_);                   // null: none waits, or it is deferred
  std::int64_t sequence_ ABSL_GUARDED_BY(mutex_) = 0;     // of frame_, or of the deferred frame
  bool deferred_ ABSL_GUARDED_BY(mutex_) = false;         // the frame is not encoded yet
  std::int64_t basis_epoch_ ABSL_GUARDED_BY(mutex_) = 0;  // of the viewer's basis; 0: none
  Bytes camera_ ABSL_GUARDED_BY(mutex_);
  std::deque<StatusUpdate> updates_ ABSL_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ ABSL_GUARDED_BY(mutex_);
  std::int64_t missed_ ABSL_GUARDED_BY(mutex_) = 0;  // frames
};

// Most status updates that a viewer may leave untaken.
inline constexpr std::size_t kMaxUpdates = 64;

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_VIEWER_H_
