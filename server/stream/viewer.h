// One viewer's mailbox: a slot for the newest frame, one for the newest camera, and the states of the session in their
// order. A frame that is not taken in time is replaced, so that a slow viewer misses frames and holds nobody up, and so
// is a camera; a change of the session is not.
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

// A serialized WatchFramesResponse, shared by all who send it.
using Bytes = std::shared_ptr<const std::string>;

// A state of the session as it travels; states of equal revision replace each other.
struct StatusUpdate {
  std::int64_t revision = 0;
  Bytes bytes;
};

struct ViewerOptions {
  double max_fps = 0;  // 0: every frame there is
  FrameEncoding form = {};
  int max_unacked = 0;       // frames; 0: without bound
  bool may_coarsen = false;  // where the line takes too few frames
  std::string watch_id = {};
};

// Any thread may call. The publisher puts, whoever serves the viewer takes.
class Viewer {
 public:
  // `wake` is called after something was put or acknowledged, by the thread that did, with no lock held; it must not
  // block.
  Viewer(const ViewerOptions& options, std::function<void()> wake)
      : options_(options),
        wake_(std::move(wake)),
        credit_({.window = options.max_unacked, .rung = options.form.rung, .may_coarsen = options.may_coarsen}) {}

  const ViewerOptions& options() const { return options_; }
  // That of the next frame.
  FrameEncoding form() const ABSL_LOCKS_EXCLUDED(mutex_);

  void PutFrame(std::int64_t sequence, Bytes frame, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // False where a frame may be taken now; else this one waits without having been made, in the place of any other.
  bool PassOver(std::int64_t sequence, absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // A viewer that leaves kMostNews changes untaken is ended with RESOURCE_EXHAUSTED.
  void PutSession(const StatusUpdate& updates) ABSL_LOCKS_EXCLUDED(mutex_);
  void PutCamera(Bytes camera) ABSL_LOCKS_EXCLUDED(mutex_);
  // Nothing more comes; what was put before may still be taken.
  void End(absl::Status reason) ABSL_LOCKS_EXCLUDED(mutex_);

  // The next message, the session's states and the camera before a frame, a frame only where few enough are
  // unacknowledged; null where there is none.
  Bytes Take(absl::Time now) ABSL_LOCKS_EXCLUDED(mutex_);
  // What came of it. `basis_epoch` is that of the basis which the viewer has.
  v1::AckFramesResponse Acknowledge(std::int64_t sequence, std::int64_t basis_epoch, absl::Time now)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // A frame waits to be made for this viewer.
  bool passed_over() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Why nothing more comes, once everything is taken that may be.
  std::optional<absl::Status> ended() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Frames that were replaced before they were taken.
  std::int64_t missed() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // This frame waits from now on: another that did was missed.
  void Wait(std::int64_t sequence, absl::Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const ViewerOptions options_;
  const std::function<void()> wake_;
  mutable absl::Mutex mutex_;
  Credit credit_ ABSL_GUARDED_BY(mutex_);
  Bytes frame_ ABSL_GUARDED_BY(mutex_);
  std::int64_t sequence_ ABSL_GUARDED_BY(mutex_) = 0;  // of frame_, or of the one that is still to be made
  bool passed_over_ ABSL_GUARDED_BY(mutex_) = false;   // it is still to be made
  std::int64_t basis_epoch_ ABSL_GUARDED_BY(mutex_) = 0;
  Bytes camera_ ABSL_GUARDED_BY(mutex_);
  std::deque<StatusUpdate> updates_ ABSL_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ ABSL_GUARDED_BY(mutex_);
  std::int64_t missed_ ABSL_GUARDED_BY(mutex_) = 0;
};

inline constexpr std::size_t kMostNews = 64;

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_VIEWER_H_
