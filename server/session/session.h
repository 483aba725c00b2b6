// One running simulation: a Run, the thread that steps it, and its viewers.
#ifndef PHRENIC_SERVER_SESSION_SESSION_H_
#define PHRENIC_SERVER_SESSION_SESSION_H_

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/synchronization/notification.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/pulls.h"
#include "server/session/control.h"
#include "server/session/cpu_share.h"
#include "server/session/idempotency_cache.h"
#include "server/session/limits.h"
#include "server/session/pace_meter.h"
#include "server/session/pacer.h"
#include "server/session/run.h"
#include "server/session/uploads.h"
#include "server/store/store.h"
#include "server/stream/publisher.h"

namespace phrenic::session {

// The simulated time that a session has come to [s], for one that plays in step with it; infinity where it does not
// play: nobody waits for one that stands. Any thread may call.
using ReachedTime = std::atomic<double>;

// Who has it, where it is saved, and what it was told last where it goes on after the server ended.
struct SessionOrigin {
  ControlBook control;
  std::shared_ptr<store::Journal> journal = nullptr;  // null: it is not saved
  std::optional<v1::SavedMoment> told = std::nullopt;
  std::int64_t epoch = 0;                    // in a cluster
  std::vector<Uploads::Held> surfaces = {};  // that clients gave, of which its scene is made
};

// Any thread may call. Calls that change something are carried out by the stepping thread between two steps, so that
// they take effect at once and never in the middle of one; they return when that is done. `token` says who calls: those
// of who may not change the session are refused with PERMISSION_DENIED (ControlBook::Check).
class Session {
 public:
  // Where a run stands, and from where another may go on.
  struct Fork {
    v1::Parameters parameters;
    State state;
    double stable_step = 0;  // the largest one for the parameters [s]
  };
  struct Stepped {
    v1::Session session;
    std::string state_hash;
    MeasureReadings measures;
  };
  struct Updated {
    v1::Session session;
    std::vector<std::string> warnings;
  };

  using Origin = SessionOrigin;

  // Paused where `start` stands, which is a state of the model; one that goes on is as it was. Every field of its
  // parameters is set and in range.
  Session(std::string id, std::shared_ptr<const Model> model, Fork start, const stream::Clock& clock,
          const Limits& limits, Origin origin = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const std::string& id() const { return id_; }
  const Model& model() const { return *model_; }
  std::shared_ptr<const Model> shared_model() const { return model_; }
  v1::Session status() const ABSL_LOCKS_EXCLUDED(mutex_);
  const std::vector<Uploads::Held>& surfaces() const { return surfaces_; }
  stream::Publisher& publisher() { return publisher_; }
  // What was answered to requests that can be repeated.
  IdempotencyCache& answers() { return idempotency_cache_; }

  // `speed` not set keeps the present one, `until` 0 never pauses. It waits where it gets a frame ahead of `leader`
  // (PlaySessionRequest.in_step_with). FAILED_PRECONDITION when the session has diverged, INVALID_ARGUMENT when `until`
  // lies behind.
  absl::StatusOr<v1::Session> Play(std::optional<double> speed, bool as_fast_as_possible, double until,
                                   std::string_view token = {}, std::weak_ptr<const ReachedTime> leader = {});
  std::shared_ptr<const ReachedTime> reached() const { return reached_; }
  absl::StatusOr<v1::Session> Pause(std::string_view token = {});
  // Pauses, takes `ticks` steps and pauses again. ABORTED when the session is at another tick than expected, when
  // somebody else steps it, or when it is played, paused or reset meanwhile; CANCELLED as soon as `cancelled` says so.
  absl::StatusOr<Stepped> Step(std::int64_t ticks, std::optional<std::int64_t> expected_tick,
                               absl::FunctionRef<bool()> cancelled, std::string_view token = {});
  // Forgets updates that wait.
  absl::StatusOr<v1::Session> Reset(std::string_view token = {});
  // Fields that are set change; they are in range. ABORTED when the session's revision is another than expected. Waits
  // for `at_tick`: FAILED_PRECONDITION where that is past, RESOURCE_EXHAUSTED where kMostWaiting wait already.
  absl::StatusOr<Updated> Update(const v1::Parameters& changes, std::optional<std::int64_t> expected_revision,
                                 std::optional<std::int64_t> at_tick = std::nullopt, std::string_view token = {})
      ABSL_LOCKS_EXCLUDED(update_mutex_);
  // Pulls vertices, or lets go of them (phrenic::ChangePulls). INVALID_ARGUMENT names what cannot be pulled.
  absl::StatusOr<v1::Session> Pull(const PullList& pulls, bool release_others, std::string_view token = {});
  // Who may see the session, on a server with accounts.
  struct Access {
    std::string account;  // whom it belongs to; empty: everybody
    std::vector<ControlState::Link> links;
  };
  std::shared_ptr<const Access> access() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Somebody asked for it now; since when nobody has, or watched.
  void NoteAttention() { attended_ = absl::ToUnixNanos(clock_.Now()); }
  absl::Time attended() const { return absl::FromUnixNanos(attended_); }
  // Pauses it, whoever controls.
  void Rest();
  // Whether this token's bearer may change the session.
  absl::Status CheckControl(std::string_view token);
  // What `act` does with control, or why it did not. Viewers are told.
  absl::StatusOr<v1::Control> ChangeControl(absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> act);
  // Shows viewers where the one who controls looks from.
  absl::Status ShowCamera(const v1::Camera& camera, std::string_view token);
  // Waits until what was answered is in the store; why it is not, where it cannot be.
  absl::Status Flush() const;
  // Removes it from the store; before Stop.
  void Forget();
  // A copy of the present state, from which another run may go on. FAILED_PRECONDITION when the session has diverged.
  absl::StatusOr<Fork> MakeFork();
  // Waits until the stepping thread has ended, after Stop: what it came to is handed to the store.
  void AwaitEnd() const { ended_.WaitForNotification(); }
  // Ends the stepping thread at once and all viewers with `reason`; later calls return it.
  void Stop(const absl::Status& reason) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // A call of Step under way.
  struct StepJob {
    std::int64_t left = 0;
    absl::Status status;
    Stepped result;
    absl::Notification done;
  };
  struct Command {
    std::function<void()> act;  // null: refused
    std::shared_ptr<absl::Notification> done;
  };

  // Has the stepping thread run `act` between two steps and waits for it; the reason of Stop when it did not.
  absl::Status Ask(absl::FunctionRef<void()> act) ABSL_LOCKS_EXCLUDED(mutex_);
  // The same where the token's bearer may change the session; what came of it.
  absl::Status AskAs(std::string_view token, absl::FunctionRef<absl::Status()> act) ABSL_LOCKS_EXCLUDED(mutex_);

  // Of the stepping thread.
  void Loop() ABSL_LOCKS_EXCLUDED(mutex_);
  bool ServeCommands() ABSL_LOCKS_EXCLUDED(mutex_);
  bool Called() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) { return !commands_.empty() || stopped_.has_value(); }
  absl::Time NextBurst() const;
  void Burst();
  bool StepOnce();
  bool Finished() const;
  double FurthestInStep() const;
  bool WaitsInStep() const;
  bool Steps() const;
  absl::Status StartPlaying(std::optional<double> speed, bool as_fast_as_possible, double until,
                            std::weak_ptr<const ReachedTime> leader);
  absl::Status StartJob(std::shared_ptr<StepJob> job, std::optional<std::int64_t> expected_tick);
  absl::Status CheckRevision(std::optional<std::int64_t> expected) const;
  absl::Status UpdateAt(const v1::Parameters& changes, double stable_step, std::optional<std::int64_t> at_tick);
  void Merge(const v1::Parameters& changes, double stable_step);
  void ApplyDueUpdates();
  // Tells of control where it changed since that was told.
  void NoteControl() ABSL_LOCKS_EXCLUDED(mutex_);
  void Halt(v1::SessionState state);
  void EndJob(absl::Status status);
  void OfferFrame(absl::Time now);
  // The status once it is in the store, or cannot be (not_saved). ABORTED where another server has the session by now.
  absl::StatusOr<v1::Session> Saved();
  // Of session_saving.cc.
  void GoOn(const v1::SavedMoment& told);
  v1::SavedMoment Moment() const;
  absl::Duration StatePause() const;
  void SaveChange(v1::Session status);
  void SaveProgress(absl::Time now);
  void SaveState(v1::SavedMoment moment);
  void Changed() ABSL_LOCKS_EXCLUDED(mutex_);
  void Tell() ABSL_LOCKS_EXCLUDED(mutex_);
  void WriteResiduals(v1::Session& status) const;
  void WriteNotSaved(v1::Session& status) const;
  void NoteProgress() ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status CheckNotDiverged() const;

  const std::string id_;
  const std::int64_t epoch_;
  const std::shared_ptr<const Model> model_;
  const std::vector<Uploads::Held> surfaces_;
  const stream::Clock& clock_;
  stream::Publisher publisher_;
  IdempotencyCache idempotency_cache_;

  absl::Mutex update_mutex_;  // one update at a time; taken before mutex_
  mutable absl::Mutex mutex_;
  v1::Session status_ ABSL_GUARDED_BY(mutex_);
  std::deque<Command> commands_ ABSL_GUARDED_BY(mutex_);  // as many as there are callers waiting
  std::optional<absl::Status> stopped_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<const Access> access_ ABSL_GUARDED_BY(mutex_);
  std::atomic<std::int64_t> attended_;  // [ns] since 1970
  std::atomic<bool> called_ = false;    // a hint to end a burst early
  const std::shared_ptr<ReachedTime> reached_ = std::make_shared<ReachedTime>(std::numeric_limits<double>::infinity());

  // Of the stepping thread alone.
  Run run_;
  Pacer pacer_;
  CpuShare share_;
  PaceMeter meter_;
  v1::SessionState state_ = v1::SESSION_STATE_PAUSED;
  double speed_ = 1;  // simulated seconds per second
  bool as_fast_as_possible_ = false;
  double until_ = 0;  // [s]; 0 never pauses
  std::weak_ptr<const ReachedTime> leader_;
  double stable_step_ = 0;  // [s]
  std::int64_t revision_ = 1;
  std::int64_t frames_ = 0;
  std::int64_t framed_tick_ = -1;  // of the newest frame
  std::shared_ptr<StepJob> job_;
  std::multimap<std::int64_t, v1::Parameters> waiting_updates_;  // by the tick that they wait for
  ControlBook control_;
  std::int64_t told_control_ = 0;  // its revision
  std::string camera_of_;          // who controlled when a camera was shown
  const std::shared_ptr<store::Journal> journal_;
  absl::Time state_saved_ = absl::InfinitePast(), progress_saved_ = absl::InfinitePast();
  std::int64_t saved_tick_ = -1;                         // of the last state that was saved
  std::int64_t saved_revision_ = 0, saved_control_ = 0;  // of the last change
  bool from_start_ = false;                              // reset since the last change was saved
  absl::Notification ended_;

  std::thread thread_;
};

inline constexpr std::size_t kMostWaiting = 256;  // updates

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SESSION_H_
