// The thread that steps a session: commands between steps, steps in bursts of one frame.
#ifndef PHRENIC_SERVER_SESSION_STEPPING_LOOP_H_
#define PHRENIC_SERVER_SESSION_STEPPING_LOOP_H_

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/notification.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/measures/readings.h"
#include "server/session/command_queue.h"
#include "server/session/control.h"
#include "server/session/cpu_share.h"
#include "server/session/pacer.h"
#include "server/session/playback.h"
#include "server/session/run.h"
#include "server/session/session_reporter.h"

namespace phrenic::session {

// What a call of Session::Step returns.
struct StepResult {
  v1::Session session;
  std::string state_hash;                         // 16 hexadecimal digits (HashText)
  MeasureReadings measures;                       // of the same state
  std::shared_ptr<const stream::Snapshot> frame;  // of the same state if all steps were taken; shared with the viewers
};

// A moment of a session that is read and not changed.
struct PresentState {
  v1::Parameters parameters;                      // at the frame's tick
  std::shared_ptr<const stream::Snapshot> frame;  // never null; shared with the viewers
  const State& state() const { return frame->state; }
};

// A call of Session::Step in progress. The stepping thread writes it, and notifies `done` when it has ended. The caller
// sets `left` before it starts the job, and reads the others after `done`.
struct StepJob {
  std::int64_t left = 0;  // ticks
  absl::Status status;    // why it ended early, or OK
  StepResult result;
  absl::Notification done;
};

// Owns the run, the thread that steps it, and everything else that changes between two steps: parameters, pulls,
// control, playback. Any thread may call the first group of methods. The second group belongs to the stepping thread:
// call it only inside Call or CallAs, so that a change is checked and made between the same two steps. Session owns it.
// While nothing steps, the thread waits for commands without using the CPU. A burst ends after a frame's time
// (1/kFramesPerSecond), or after the step in progress as soon as a command waits.
class SteppingLoop {
 public:
  // Starts the thread at `session`, which gets `cpu_share` of a core; 1 is no limit. A session that is `held` takes no
  // step of a playback until Release. `clock` and `reporter` outlive the loop.
  SteppingLoop(RunningSession session, double cpu_share, const Clock& clock, SessionReporter& reporter,
               bool held = false);
  // Waits for the thread to end. Requires: Stop was called. Commands that wait when the loop is stopped do not run.
  ~SteppingLoop();
  SteppingLoop(const SteppingLoop&) = delete;
  SteppingLoop& operator=(const SteppingLoop&) = delete;

  // --- any thread ---
  // Runs `act` on the stepping thread between two steps and waits for it. Returns the reason of Stop if it did not run.
  // A call from the stepping thread would wait for itself.
  absl::Status Call(absl::FunctionRef<void()> act) { return commands_.Call(act); }
  // The same, if the token's bearer may change the session (ControlBook::Check). Returns what `act` returns.
  // PERMISSION_DENIED otherwise. The check renews the bearer's time to live.
  absl::Status CallAs(std::string_view token, absl::FunctionRef<absl::Status()> act);
  // Simulated time that followers read [s]; infinity unless the session plays.
  std::shared_ptr<const ReachedTime> reached() const { return reached_; }
  // Ends the thread soon; later calls return `reason`. Returns false if it was stopped before. A StepJob in progress
  // ends with CANCELLED.
  bool Stop(const absl::Status& reason) { return commands_.Close(reason); }
  // Waits until the thread has handed its last state to the store. Requires: Stop was called.
  void AwaitEnd() const { ended_.WaitForNotification(); }

  // --- the stepping thread ---
  // The errors of Session::Play. Ends a StepJob in progress with ABORTED.
  absl::Status Play(const PlayRequest& request);
  // Pauses a playing session, and ends a StepJob in progress with ABORTED and `reason`.
  void Pause(const std::string& reason);
  // Lets a held session play, from now on the wall clock. Does nothing if it is not held.
  void Release();
  // Returns to t = 0, paused. Discards waiting updates and keeps parameters and pulls.
  void Reset();
  // The errors of Session::Step. Steps `job->left` times. The loop notifies job->done at the end, also if it diverges
  // or is cancelled.
  absl::Status StartJob(std::shared_ptr<StepJob> job, std::optional<std::int64_t> expected_tick);
  // Ends `job` if it is the one in progress.
  void CancelJob(const StepJob& job, absl::Status status);
  // Changes the parameters now, or at a later tick. `stable_step` is that of the changed parameters [s]. The errors of
  // Session::Update.
  absl::Status Update(const v1::Parameters& changes, double stable_step, std::optional<std::int64_t> expected_revision,
                      std::optional<std::int64_t> at_tick);
  // RESOURCE_EXHAUSTED if there would be more than kMostPulls.
  absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool release_others);
  // FAILED_PRECONDITION if the session has diverged. Copies parameters and state.
  absl::StatusOr<Fork> MakeFork() const;
  // The same error. Shares the newest frame; copies a state only if nothing steps and no frame of this tick was made.
  absl::StatusOr<PresentState> ReadState();
  // Reports control if `change` has changed it. Returns what clients may know of it, or the error of `change`.
  absl::StatusOr<v1::Control> ChangeControl(absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> change);
  // The errors of ControlBook::CheckAlone.
  absl::Status ShowCamera(const v1::Camera& camera, std::string_view token);

 private:
  // The thread's function: commands, then a burst if the session may step, until Stop.
  void Loop();
  bool ServeCommands();
  // Returns when to step next: never while paused; at once for a job or as fast as possible, but not before the CPU
  // share allows it; otherwise when the next frame is due, or 1 ms later while it waits for its leader.
  absl::Time NextBurst() const;
  // True if the session plays and is not held.
  bool Plays() const { return session_.phase == v1::SESSION_STATE_PLAYING && !held_; }
  // True if there is something to step, the CPU share allows it, and the leader is not behind.
  bool MayStep() const;
  // True if the next step would pass the time up to which the session may run ahead of its leader.
  bool WaitsInStep() const;
  void Burst();
  // Takes a step, and applies the updates that are due after it. Returns false if it diverged.
  bool StepOnce();
  // Reports the burst: the divergence, the end of the job or of the playback, or the progress and a frame.
  void EndBurst(absl::Time start);
  bool Finished() const;

  // FAILED_PRECONDITION, with where the session diverged and the remedy.
  absl::Status CheckNotDiverged() const;
  // ABORTED unless `expected` is the present revision, or not set.
  absl::Status CheckRevision(std::optional<std::int64_t> expected) const;
  // Applies a change of parameters now. `stable_step` [s] is that of the changed parameters.
  void Merge(const v1::Parameters& changes, double stable_step);
  void ApplyDueUpdates();
  // Enters `state`, in which nothing steps: stops the playback, reports the session, and offers a frame.
  void Halt(v1::SessionState state);
  // Fills in the result, wakes the caller, and forgets the job. Does nothing without a job.
  void EndJob(absl::Status status);

  // Counts a change of state or parameters, and reports it.
  void NoteChange();
  void OfferFrame(absl::Time now);

  const Clock& clock_;
  SessionReporter& reporter_;
  CommandQueue commands_;
  const std::shared_ptr<ReachedTime> reached_ = std::make_shared<ReachedTime>(std::numeric_limits<double>::infinity());

  // Of the stepping thread alone.
  RunningSession session_;
  std::shared_ptr<StepJob> job_;  // null: none is in progress
  Pacer pacer_;
  CpuShare cpu_share_;
  bool held_;  // until Release

  absl::Notification ended_;
  std::thread thread_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_STEPPING_LOOP_H_
