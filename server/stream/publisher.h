// Encodes the frames of one session, once for all viewers, and puts them into the viewers' mailboxes.
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
#include "server/schema/clock.h"
#include "server/stream/encoder.h"
#include "server/stream/frame.h"
#include "server/stream/viewer.h"

namespace phrenic::stream {

// Thread-safe; a thread of its own encodes and delivers, so that the stepping thread does neither. A frame is encoded
// only in the encodings of viewers that may be sent one; for a viewer that has not acknowledged earlier frames the
// newest frame is deferred. The thread starts with the first viewer. Session owns it. mutex_ is not held while a frame
// is encoded or put into a mailbox.
class Publisher {
 public:
  // `clock` outlives the publisher.
  Publisher(std::shared_ptr<const Model> model, const Clock& clock, int max_viewers);
  // Ends the viewers with UNAVAILABLE and waits for the thread.
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  // Sets the newest snapshot. Replaces one that is not encoded yet. The stepping thread calls it; it never waits for
  // viewers. Requires: sequence numbers grow.
  void Offer(std::shared_ptr<const Snapshot> snapshot) ABSL_LOCKS_EXCLUDED(mutex_);
  // Sends the session's status to all viewers; sets its field `viewers`. An update that waits is replaced if it has the
  // same revision.
  void Announce(const v1::Session& session) ABSL_LOCKS_EXCLUDED(mutex_);
  // Sends the camera of the controlling client to all present and later viewers; null stops that.
  void ShowCamera(Bytes camera) ABSL_LOCKS_EXCLUDED(mutex_);

  // Adds a viewer. It gets the session's status at once, then the newest frame, then all that follows.
  // RESOURCE_EXHAUSTED if there are max_viewers; ALREADY_EXISTS if a viewer with the same watch_id exists; the reason
  // of Close after Close. `wake` runs on the publisher's thread and on those that call Close and Acknowledge (Viewer).
  absl::StatusOr<std::shared_ptr<Viewer>> Join(const ViewerOptions& options, std::function<void()> wake)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Does nothing if the viewer has left. The publisher may still put messages that it is delivering.
  void Leave(const std::shared_ptr<Viewer>& viewer) ABSL_LOCKS_EXCLUDED(mutex_);
  // Ends every viewer with `reason` and stops the thread. Nothing is delivered afterwards. Does not wait. A second call
  // has no effect.
  void Close(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);

  // Records frames as received by the viewer with the request's watch_id. NOT_FOUND if no viewer has it. The response
  // has the viewer's flow control and, for CODEC_BASIS, the epoch of the newest basis.
  absl::StatusOr<v1::AckFramesResponse> Acknowledge(const v1::AckFramesRequest& request) ABSL_LOCKS_EXCLUDED(mutex_);

  int viewers() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the newest basis; null before the first.
  std::shared_ptr<const Basis> basis() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the number of position encodings so far.
  std::int64_t encodings() const ABSL_LOCKS_EXCLUDED(mutex_);
  const Layout& layout() const { return layout_; }

 private:
  // A viewer and what it has been sent.
  struct Subscription {
    std::shared_ptr<Viewer> viewer;
    std::int64_t sequence = 0;              // of the newest frame
    bool greeted = false;                   // true if it has the session's status
    std::int64_t passed = 0;                // the newest frame that was deferred
    absl::Time due = absl::InfinitePast();  // earliest time of the next frame
  };
  using Viewers = std::vector<std::shared_ptr<Viewer>>;
  // What to put into which mailboxes.
  struct Round {
    std::shared_ptr<const Snapshot> snapshot;
    std::vector<v1::Session> updates;
    Viewers greeted, newcomers;  // newcomers get only the last of the updates
    Bytes camera;
    bool camera_moved = false;
    std::map<FrameEncoding, Viewers> frames;
  };

  // The thread's function: waits for work or the next frame that is due, takes a round, delivers it; until Close.
  void Run() ABSL_LOCKS_EXCLUDED(mutex_);
  bool HasWork() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return has_work_ || closed_.has_value(); }
  // Returns when a viewer may get the newest frame; the infinite future if all have got or deferred it.
  absl::Time NextDue() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Takes what waits, and greets newcomers.
  Round TakeRound(absl::Time now) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Chooses which viewers get the newest frame, by encoding.
  void TakeFrames(absl::Time now, Round& round) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Statuses first, then the camera, then frames.
  void Deliver(const Round& round) ABSL_LOCKS_EXCLUDED(mutex_);
  static void DeliverCamera(const Round& round);
  // Encodes each frame once per encoding.
  void DeliverFrames(const Round& round) ABSL_LOCKS_EXCLUDED(mutex_);
  // Queues the status with the number of viewers, if there are any.
  void SessionChanged() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::shared_ptr<const Model> model_;
  const Layout layout_;
  const Clock& clock_;
  const int max_viewers_;
  mutable absl::Mutex mutex_;
  std::shared_ptr<const Snapshot> newest_ ABSL_GUARDED_BY(mutex_);  // null before the first
  v1::Session session_ ABSL_GUARDED_BY(mutex_);                     // the newest status
  std::vector<v1::Session> updates_ ABSL_GUARDED_BY(mutex_);        // not delivered yet
  Bytes camera_ ABSL_GUARDED_BY(mutex_);                            // null: none is shown
  bool camera_moved_ ABSL_GUARDED_BY(mutex_) = false;               // not delivered yet
  std::vector<Subscription> subscriptions_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, std::shared_ptr<Viewer>> named_
      ABSL_GUARDED_BY(mutex_);                                  // those of subscriptions_ that have a watch_id
  bool has_work_ ABSL_GUARDED_BY(mutex_) = false;               // something changed since the last round
  std::optional<absl::Status> closed_ ABSL_GUARDED_BY(mutex_);  // the reason of Close
  std::int64_t encodings_ ABSL_GUARDED_BY(mutex_) = 0;
  std::shared_ptr<const Basis> basis_ ABSL_GUARDED_BY(mutex_);  // a copy of the encoder's, for other threads
  Encoder encoder_;                                             // used only by the publisher's thread
  std::thread thread_ ABSL_GUARDED_BY(mutex_);                  // from the first viewer on
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_PUBLISHER_H_
