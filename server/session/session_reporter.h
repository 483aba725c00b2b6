// Reports what the stepping thread does: the status to callers and viewers, frames to viewers, samples to readers,
// moments to the store.
#ifndef PHRENIC_SERVER_SESSION_SESSION_REPORTER_H_
#define PHRENIC_SERVER_SESSION_SESSION_REPORTER_H_

#include <cstdint>
#include <memory>
#include <string>

#include "absl/time/time.h"
#include "phrenic/v1/saved.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/schema/clock.h"
#include "server/session/control.h"
#include "server/session/pace_meter.h"
#include "server/session/playback.h"
#include "server/session/run.h"
#include "server/session/session_saver.h"
#include "server/session/status_board.h"
#include "server/session/update_schedule.h"
#include "server/stream/publisher.h"
#include "server/stream/sampler.h"

namespace phrenic::session {

// Everything that changes in a session, apart from its viewers. The stepping thread owns it. Not thread-safe.
struct RunningSession {
  Run run;
  ControlBook control;
  double stable_step = 0;  // the largest one for the run's parameters [s]
  v1::SessionState phase = v1::SESSION_STATE_PAUSED;
  std::int64_t revision = 1;  // grows with every change of parameters, pulls or phase
  Playback playback = {};
  UpdateSchedule updates = {};
  PaceMeter meter = {};

  // Takes over what a saved moment says, apart from the run, which is at that moment already, and control.
  void Restore(const v1::SavedMoment& saved);
};

// The stepping thread calls it, except for status(), which any thread may call. Session owns it. Other threads see what
// it writes to the board; no method waits for viewers or the disk.
class SessionReporter {
 public:
  // All outlive the reporter.
  SessionReporter(const Clock& clock, StatusBoard& board, SessionSaver& saver, stream::Publisher& publisher,
                  stream::Sampler& sampler)
      : clock_(clock), board_(board), saver_(saver), publisher_(publisher), sampler_(sampler) {}

  // Returns the status with the number of viewers, and why it is not saved.
  v1::Session status() const;

  // Writes the whole status, announces it to viewers, and saves the session. The first report comes from the loop's
  // constructor, before its thread starts.
  void Report(const RunningSession& session);
  // Reports control if it has changed since the last report. A renewal of the holder's time goes to the board alone.
  // Stops showing a camera if another person controls now.
  void ReportControl(const RunningSession& session);
  // Reports the time of a running session: to viewers if `measured`, when its pace is new; to the store when it is due.
  void ReportProgress(const RunningSession& session, bool measured, absl::Time now);
  // Saves the last state of a session that ends.
  void ReportEnd(const RunningSession& session);
  // Offers a frame of the present state to viewers, unless the newest frame has the same tick. Copies the state and the
  // parameters; viewers may skip the frame.
  void OfferFrame(const RunningSession& session, absl::Time now);
  // Returns the newest frame that was offered; null before the first, which comes from the loop's constructor.
  const std::shared_ptr<const stream::Snapshot>& newest_frame() const { return newest_; }
  // Takes the samples that are due after a step. Costs a comparison if none is due.
  void NoteStep(const RunningSession& session) { sampler_.Note(session.run.parameters(), session.run.state()); }
  // Takes a sample at t = 0, makes the next OfferFrame offer a frame in any case, and the next save begin at t = 0.
  void NoteReset(const RunningSession& session);
  // Shows viewers a camera, until another person controls than now.
  void ShowCamera(const RunningSession& session, const v1::Camera& camera);

 private:
  // Writes all fields that the session's own thread knows, with the residuals of the constraints [m].
  void WriteStatus(const RunningSession& session, v1::Session& status) const;
  // Adds to `status` what only the store needs: playback, tokens, waiting updates.
  static v1::SavedMoment MomentOf(const RunningSession& session, v1::Session status);

  const Clock& clock_;
  StatusBoard& board_;
  SessionSaver& saver_;
  stream::Publisher& publisher_;
  stream::Sampler& sampler_;
  std::int64_t frames_ = 0;        // offered so far: the sequence number of the newest
  std::int64_t framed_tick_ = -1;  // of the newest frame
  std::shared_ptr<const stream::Snapshot> newest_;
  std::int64_t reported_control_ = 0;  // the revision of the control that was reported last
  std::string camera_of_;              // the controller who shows a camera; empty: none is shown
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SESSION_REPORTER_H_
