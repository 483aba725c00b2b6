// One viewer's mailbox: a slot for the newest frame and one for the newest state of the session. What is not taken in
// time is replaced, so that a slow viewer misses frames and holds nobody up.
#ifndef PHRENIC_SERVER_STREAM_VIEWER_H_
#define PHRENIC_SERVER_STREAM_VIEWER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/status.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::stream {

// A serialized WatchFramesResponse, shared by all who send it.
using Bytes = std::shared_ptr<const std::string>;

struct ViewerOptions {
  double max_fps = 0;         // 0: every frame there is
  bool numbers_only = false;  // frames without positions and poses
};

// Any thread may call. The publisher puts, whoever serves the viewer takes.
class Viewer {
 public:
  // `wake` is called after something was put, by the thread that put it, with no lock held; it must not block.
  Viewer(const ViewerOptions& options, std::function<void()> wake) : options_(options), wake_(std::move(wake)) {}

  const ViewerOptions& options() const { return options_; }

  void PutFrame(Bytes frame) ABSL_LOCKS_EXCLUDED(mutex_);
  void PutSession(Bytes session) ABSL_LOCKS_EXCLUDED(mutex_);
  // Nothing more comes; what was put before may still be taken.
  void End(absl::Status reason) ABSL_LOCKS_EXCLUDED(mutex_);

  // The next message, the session's state before a frame; null where there is none.
  Bytes Take() ABSL_LOCKS_EXCLUDED(mutex_);
  // Why nothing more comes, once everything is taken.
  std::optional<absl::Status> ended() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Frames that were replaced before they were taken.
  std::int64_t missed() const ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  const ViewerOptions options_;
  const std::function<void()> wake_;
  mutable absl::Mutex mutex_;
  Bytes frame_ ABSL_GUARDED_BY(mutex_);
  Bytes session_ ABSL_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ ABSL_GUARDED_BY(mutex_);
  std::int64_t missed_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_VIEWER_H_
