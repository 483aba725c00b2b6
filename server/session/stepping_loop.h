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
  std::string state_hash;
  MeasureReadings measures;
};

// A call of Session::Step in progress. The stepping thread writes it, and notifies `done` when it has ended.
struct StepJob {
  std::int64_t left = 0;  // ticks
  absl::Status status;
  StepResult result;
  absl::Notification done;
};

// Owns the run, the thread that steps it, and everything else that changes between two steps: parameters, pulls,
// control, playback. Any thread may call the first group of methods. The second group belongs to the stepping thread:
// call it only inside Call or CallAs, so that a change is checked and made between the same two steps.
class SteppingLoop {
 public:
  // Starts the thread at `session`, which gets `cpu_share` of a core; 1 is no limit. `clock` and `reporter` outlive the
  // loop.
  SteppingLoop(RunningSession session, double cpu_share, const Clock& clock, SessionReporter& reporter);
  // Waits for the thread to end. Requires: Stop was called.
  ~SteppingLoop();
  SteppingLoop(const SteppingLoop&) = delete;
  SteppingLoop& operator=(const SteppingLoop&) = delete;

  // --- any thread ---
  // Runs `act` on the stepping thread between two steps and waits for it. Returns the reason of Stop if it did not run.
  absl::Status Call(absl::FunctionRef<void()> act) { return commands_.Call(act); }
  // The same, if the token's bearer may change the session (ControlBook::Check). Returns what `act` returns.
  absl::Status CallAs(std::string_view token, absl::FunctionRef<absl::Status()> act);
  std::shared_ptr<const ReachedTime> reached() const { return reached_; }
  // Ends the thread soon; later calls return `reason`. Returns false if it was stopped before.
  bool Stop(const absl::Status& reason) { return commands_.Close(reason); }
  // Waits until the thread has handed its last state to the store. Requires: Stop was called.
  void AwaitEnd() const { ended_.WaitForNotification(); }

  // --- the stepping thread ---
  // The errors of Session::Play.
  absl::Status Play(const PlayRequest& request);
  // Pauses a playing session, and ends a StepJob in progress with ABORTED and `reason`.
  void Pause(const std::string& reason);
  void Reset();
  // The errors of Session::Step. Steps `job->left` times.
  absl::Status StartJob(std::shared_ptr<StepJob> job, std::optional<std::int64_t> expected_tick);
  // Ends `job` if it is the one in progress.
  void CancelJob(const StepJob& job, absl::Status status);
  // Changes the parameters now, or at a later tick. `stable_step` is that of the changed parameters [s]. The errors of
  // Session::Update.
  absl::Status Update(const v1::Parameters& changes, double stable_step, std::optional<std::int64_t> expected_revision,
                      std::optional<std::int64_t> at_tick);
  absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool release_others);
  // FAILED_PRECONDITION if the session has diverged.
  absl::StatusOr<Fork> MakeFork() const;
  absl::StatusOr<v1::Control> ChangeControl(absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> change);
  // The errors of ControlBook::CheckAlone.
  absl::Status ShowCamera(const v1::Camera& camera, std::string_view token);

 private:
  void Loop();
  bool ServeCommands();
  absl::Time NextBurst() const;
  bool MayStep() const;
  bool WaitsInStep() const;
  void Burst();
  bool StepOnce();
  void EndBurst(absl::Time start);
  bool Finished() const;

  absl::Status CheckNotDiverged() const;
  absl::Status CheckRevision(std::optional<std::int64_t> expected) const;
  void Merge(const v1::Parameters& changes, double stable_step);
  void ApplyDueUpdates();
  void Halt(v1::SessionState state);
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

  absl::Notification ended_;
  std::thread thread_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_STEPPING_LOOP_H_
