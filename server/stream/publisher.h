// Encodes the frames of one session, each once however many watch, and puts them into the viewers' mailboxes.
#ifndef PHRENIC_SERVER_STREAM_PUBLISHER_H_
#define PHRENIC_SERVER_STREAM_PUBLISHER_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/session.pb.h"
#include "server/stream/clock.h"
#include "server/stream/encoder.h"
#include "server/stream/frame.h"
#include "server/stream/viewer.h"

namespace phrenic::stream {

// Any thread may call; its own thread encodes and delivers, so that the stepping thread does neither. A frame is
// encoded in the forms that somebody may take: not for viewers who have yet to acknowledge earlier ones, whom the
// newest waits for. A session that nobody ever watched has no such thread.
class Publisher {
 public:
  Publisher(std::shared_ptr<const Model> model, const Clock& clock, int max_viewers);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // The newest moment; replaces one that was not encoded yet.
  void Offer(std::shared_ptr<const Snapshot> snapshot) ABSL_LOCKS_EXCLUDED(mutex_);
  // The newest state of the session; `viewers` of it is filled in here.
  void Announce(const v1::Session& session) ABSL_LOCKS_EXCLUDED(mutex_);
  // Where the one who controls looks from, for those who watch and those who come; null: nobody shows it any more.
  void ShowCamera(Bytes camera) ABSL_LOCKS_EXCLUDED(mutex_);

  // The viewer gets the session's state at once, then the newest frame, then what comes. RESOURCE_EXHAUSTED when there
  // are too many already, and the reason of Close after it.
  // ALREADY_EXISTS when another watches under the same name.
  absl::StatusOr<std::shared_ptr<Viewer>> Join(const ViewerOptions& options, std::function<void()> wake)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void Leave(const std::shared_ptr<Viewer>& viewer) ABSL_LOCKS_EXCLUDED(mutex_);
  // Ends every viewer with `reason` and the thread; nothing is delivered afterwards.
  void Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);

  // The viewer of that name has taken frames; NOT_FOUND where there is none.
  absl::StatusOr<v1::AckFramesResponse> Acknowledge(const v1::AckFramesRequest& request) ABSL_LOCKS_EXCLUDED(mutex_);

  int viewers() const ABSL_LOCKS_EXCLUDED(mutex_);
  // The newest; null where there is none.
  std::shared_ptr<const Basis> basis() const ABSL_LOCKS_EXCLUDED(mutex_);
  // How often positions were encoded.
  std::int64_t encodings() const ABSL_LOCKS_EXCLUDED(mutex_);
  const Layout& layout() const { return layout_; }

 private:
  // What one viewer has had.
  struct Subscription {
    std::shared_ptr<Viewer> viewer;
    std::int64_t sequence = 0;              // of the newest frame
    bool greeted = false;                   // was told the session's state
    std::int64_t passed = 0;                // the newest frame that was not made for it
    absl::Time due = absl::InfinitePast();  // no frame before this
  };
  using Viewers = std::vector<std::shared_ptr<Viewer>>;
  // What is to be put into whose mailbox.
  struct Round {
    std::shared_ptr<const Snapshot> snapshot;
    std::vector<v1::Session> updates;
    Viewers greeted, newcomers;  // newcomers hear the last of the updates only
    Bytes camera;
    bool camera_moved = false;
    std::map<FrameEncoding, Viewers> frames;
  };

  void Run() ABSL_LOCKS_EXCLUDED(mutex_);
  bool Stirred() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return stirred_ || closed_.has_value(); }
  absl::Time NextDue() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Round TakeRound(absl::Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Chooses who gets the newest frame, and in which form.
  void TakeFrames(absl::Time now, Round& round) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void Deliver(const Round& round) ABSL_LOCKS_EXCLUDED(mutex_);
  static void DeliverCamera(const Round& round);
  void DeliverFrames(const Round& round) ABSL_LOCKS_EXCLUDED(mutex_);
  void SessionChanged() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::shared_ptr<const Model> model_;
  const Layout layout_;
  const Clock& clock_;
  const int max_viewers_;
  mutable absl::Mutex mutex_;
  std::shared_ptr<const Snapshot> newest_ ABSL_GUARDED_BY(mutex_);
  v1::Session session_ ABSL_GUARDED_BY(mutex_);
  std::vector<v1::Session> updates_ ABSL_GUARDED_BY(mutex_);  // not told yet
  Bytes camera_ ABSL_GUARDED_BY(mutex_);
  bool camera_moved_ ABSL_GUARDED_BY(mutex_) = false;  // not told yet
  std::vector<Subscription> subscriptions_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, std::shared_ptr<Viewer>> named_
      ABSL_GUARDED_BY(mutex_);                    // those of subscriptions_ that have a name
  bool stirred_ ABSL_GUARDED_BY(mutex_) = false;  // something came since the last round
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);
  std::int64_t encodings_ ABSL_GUARDED_BY(mutex_) = 0;
  std::shared_ptr<const Basis> basis_ ABSL_GUARDED_BY(mutex_);
  Encoder encoder_;                             // of the publisher's thread only
  std::thread thread_ ABSL_GUARDED_BY(mutex_);  // since the first viewer came
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_PUBLISHER_H_
