// One running simulation and its viewers, as callers see it.
#ifndef PHRENIC_SERVER_SESSION_SESSION_H_
#define PHRENIC_SERVER_SESSION_SESSION_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/pulls.h"
#include "server/session/classroom/answer_book.h"
#include "server/session/control.h"
#include "server/session/idempotency_cache.h"
#include "server/session/limits.h"
#include "server/session/session_reporter.h"
#include "server/session/session_saver.h"
#include "server/session/status_board.h"
#include "server/session/stepping_loop.h"
#include "server/session/uploads.h"
#include "server/store/store.h"
#include "server/stream/publisher.h"
#include "server/stream/sampler.h"

namespace phrenic::session {

// What a session starts with beside its model and state. Plain data, which Table fills.
struct SessionOrigin {
  ControlBook control;                                         // default: everybody controls
  std::shared_ptr<store::Journal> journal = nullptr;           // null: the session is not saved
  std::optional<v1::SavedMoment> saved_moment = std::nullopt;  // the last one of a session that continues
  std::int64_t epoch = 0;                                      // in a cluster
  std::vector<Uploads::Held> surfaces = {};                    // uploaded files that the scene uses
  bool temporary = false;                                      // v1::Session.temporary
  bool held = false;                                           // until Session::Release
};

// Thread-safe. The stepping thread (SteppingLoop) makes every change between two steps, so that it takes effect at once
// and never in the middle of a step; the call returns when that is done and saved: steps survive the end of the
// process, other changes a power failure as well (store::Durability). `token` identifies the caller, who gets
// PERMISSION_DENIED unless they control the session (ControlBook::Check). In a cluster, a change returns UNAVAILABLE
// and does nothing if another server may have the session (store::Ownership::CheckLease). Table creates sessions; calls
// in progress share them (std::shared_ptr), so that a session may outlive its deletion. A change waits for the step in
// progress, never for a whole burst. Never call a change from the stepping thread: it would wait for itself.
class Session {
 public:
  using Fork = session::Fork;
  using Origin = SessionOrigin;
  using Stepped = StepResult;
  using Access = SessionAccess;
  struct Updated {
    v1::Session session;                // after the change
    std::vector<std::string> warnings;  // names the time step if it is above the largest stable one
  };

  // Starts paused at `start`, which is a state of the model, or continues as `origin.saved_moment` says. Every field of
  // the parameters is set and in range. `clock` outlives the session. Starts the stepping thread, which hands the first
  // state to the journal; Flush waits for it.
  Session(std::string id, std::shared_ptr<const Model> model, Fork start, const Clock& clock, const Limits& limits,
          Origin origin = {});
  // Ends the viewers with UNAVAILABLE, and waits for the stepping thread.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const std::string& id() const { return id_; }
  // The model is immutable; sessions of the same scene and exports share it.
  const Model& model() const { return *model_; }
  std::shared_ptr<const Model> shared_model() const { return model_; }
  // Returns a copy of the latest status, with the present number of viewers. Does not wait for the stepping thread, so
  // its time may be that of the last burst.
  v1::Session status() const { return reporter_.status(); }
  // Uploaded files that the scene uses. Forks and exports share them, so that they can be saved again.
  const std::vector<Uploads::Held>& surfaces() const { return surfaces_; }
  // Viewers subscribe here. It lives as long as the session.
  stream::Publisher& publisher() { return publisher_; }
  // Readers of measures subscribe here. It lives as long as the session.
  stream::Sampler& sampler() { return sampler_; }
  // The answers to requests that have an id.
  IdempotencyCache& answers() { return idempotency_cache_; }
  // The class's answers to the questions of lessons. Not saved.
  AnswerBook& answer_book() { return answer_book_; }

  // Plays. A speed that is not set keeps the present one; `until` 0 never pauses. The session waits while it is a frame
  // ahead of `leader` (PlaySessionRequest.in_step_with). Returns FAILED_PRECONDITION if the session has diverged,
  // INVALID_ARGUMENT if `until` is in the past. `speed` is in simulated seconds per second, `until` a simulated time
  // [s]. Ends a Step in progress with ABORTED.
  absl::StatusOr<v1::Session> Play(std::optional<double> speed, bool as_fast_as_possible, double until,
                                   std::string_view token = {}, std::weak_ptr<const ReachedTime> leader = {});
  // The same, also with `keep_playing`: the session plays on without viewers.
  absl::StatusOr<v1::Session> Play(const PlayRequest& request, std::string_view token);
  // Lets a session that was restored as held play. Table::Restore calls it. Does nothing if the session has ended.
  void Release();
  // The time that followers of this session read. [s]; infinity unless the session plays. It may outlive the session.
  std::shared_ptr<const ReachedTime> reached() const { return loop_.reached(); }
  // Pauses a playing session, and ends a Step in progress with ABORTED.
  absl::StatusOr<v1::Session> Pause(std::string_view token = {});
  // Pauses, takes `ticks` steps and pauses again. Returns ABORTED if the session is not at `expected_tick`, if another
  // caller steps it, or if it is played, paused or reset meanwhile; CANCELLED as soon as `cancelled` returns true.
  // Returns OUT_OF_RANGE if a step diverges, FAILED_PRECONDITION if the session had diverged before. Steps without
  // regard to wall-clock time, as fast as the session's CPU share allows; the calling thread asks `cancelled` every 50
  // ms. The result has the session's status and the state's hash after the last step, and the frame of that state.
  absl::StatusOr<Stepped> Step(std::int64_t ticks, std::optional<std::int64_t> expected_tick,
                               absl::FunctionRef<bool()> cancelled, std::string_view token = {});
  // Returns to t = 0 and discards waiting updates. Keeps parameters and pulls, forgets a divergence, and pauses. Ends a
  // Step in progress with ABORTED.
  absl::StatusOr<v1::Session> Reset(std::string_view token = {});
  // Changes the fields that are set in `changes`, which are in range, at `at_tick` or now. Returns ABORTED if the
  // session is not at `expected_revision`, FAILED_PRECONDITION if `at_tick` is past, RESOURCE_EXHAUSTED if kMostWaiting
  // updates wait. Computes the largest stable step on the calling thread, which may take a while; concurrent updates
  // wait for each other.
  absl::StatusOr<Updated> Update(const v1::Parameters& changes, std::optional<std::int64_t> expected_revision,
                                 std::optional<std::int64_t> at_tick = std::nullopt, std::string_view token = {})
      ABSL_LOCKS_EXCLUDED(update_mutex_);
  // Pulls vertices, or releases them (phrenic::ChangePulls). INVALID_ARGUMENT names a vertex that cannot be pulled.
  // RESOURCE_EXHAUSTED past kMostPulls. `release_others` removes the pulls on all other vertices.
  absl::StatusOr<v1::Session> Pull(const PullList& pulls, bool release_others, std::string_view token = {});

  // Who may see the session. As last reported; does not wait for the stepping thread.
  std::shared_ptr<const Access> access() const { return board_.access(); }
  // Notes that a caller asked for the session now. Table::Find calls it.
  void NoteAttention() { attended_ = absl::ToUnixNanos(clock_.Now()); }
  // Returns the time of the last NoteAttention. Table::Tend pauses and deletes sessions by it.
  absl::Time attended() const { return absl::FromUnixNanos(attended_); }
  // Pauses the session without regard to control. For Table::Tend. Does nothing if the session has ended.
  void Rest();
  // Announces the status to viewers if `not_saved` has changed since the last call. Not thread-safe. Only Table::Tend
  // calls it.
  void AnnounceNotSaved();
  // Returns OK if the token's bearer may change the session. Renews the bearer's time. Otherwise returns
  // PERMISSION_DENIED, or the error of store::Ownership::CheckLease.
  absl::Status CheckControl(std::string_view token);
  // The same for the bearer who alone controls (ControlBook::CheckAlone).
  absl::Status CheckSoleControl(std::string_view token);
  // Changes control by `act`, tells viewers, and returns the errors of `act`, or of Acknowledge. `act` runs on the
  // stepping thread, at the time `now` of the session's clock. Also waits until the change is in the store.
  absl::StatusOr<v1::Control> ChangeControl(absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> act);
  // Shows viewers the camera of the one who controls. PERMISSION_DENIED unless the bearer alone controls
  // (ControlBook::CheckAlone). The camera is not saved.
  absl::Status ShowCamera(const v1::Camera& camera, std::string_view token);

  // Waits until everything that calls have returned is in the store. Returns the errors of store::Journal::Flush.
  absl::Status Flush() const { return saver_.Flush(store::Durability::kPower); }
  // In a cluster, waits until other servers would continue from what calls have returned, before they are answered.
  // Returns the errors of store::Journal::AwaitCopy.
  absl::Status Acknowledge() const { return saver_.AwaitCopy(); }
  // Removes the session from the store. Requires: Stop was not called yet.
  void Forget() { saver_.Forget(); }
  // Copies the present state, from which another run may continue. FAILED_PRECONDITION if the session has diverged.
  // Waits for the step in progress; the copy is independent of the session.
  absl::StatusOr<Fork> MakeFork();
  // Reads the present state, shared with the viewers: while the session steps, that of the newest frame, which is at
  // most a frame old. The same error and the same wait; the stepping thread does no work that grows with the model.
  absl::StatusOr<PresentState> ReadState();
  // Waits until the stepping thread has handed its last state to the store. Requires: Stop was called.
  void AwaitEnd() const { loop_.AwaitEnd(); }
  // Ends the stepping thread soon and all viewers with `reason`, which later calls return. Does not wait for the
  // thread. A second call has no effect.
  void Stop(const absl::Status& reason);

 private:
  // Returns the status once it is in the store, with `not_saved` if it cannot be.
  v1::Session Saved(store::Durability durability = store::Durability::kPower);
  // Runs `act` on the stepping thread for the token's bearer, if this server may change the session.
  absl::Status CallToChange(std::string_view token, absl::FunctionRef<absl::Status()> act);
  // Runs `act` on the stepping thread for the token's bearer; the errors of both, else Saved().
  absl::StatusOr<v1::Session> Change(std::string_view token, absl::FunctionRef<absl::Status()> act);

  const std::string id_;
  const std::shared_ptr<const Model> model_;  // shared with forks and exports
  const std::vector<Uploads::Held> surfaces_;
  const Clock& clock_;
  stream::Publisher publisher_;
  stream::Sampler sampler_;
  IdempotencyCache idempotency_cache_;
  AnswerBook answer_book_;
  absl::Mutex update_mutex_;            // held by one call of Update at a time
  std::atomic<std::int64_t> attended_;  // [ns] since 1970
  std::string announced_not_saved_;     // of AnnounceNotSaved
  StatusBoard board_;                   // read by any thread, written by the stepping thread
  SessionSaver saver_;
  SessionReporter reporter_;
  SteppingLoop loop_;  // the last: its thread uses the others
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SESSION_H_
