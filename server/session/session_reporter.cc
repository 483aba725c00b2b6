#include "server/session/session_reporter.h"

#include <utility>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/pulls.h"
#include "server/mechanics/state_warnings.h"
#include "server/session/saving.h"
#include "server/stream/encoder.h"

namespace phrenic::session {
namespace {

// How well the last step was solved, and how far the state is from satisfying the constraints [m].
void WriteResiduals(const Run& run, v1::Session& status) {
  status.clear_solver_residual();
  status.clear_solver_iterations();
  if (run.effort().iterations() > 0) {
    status.set_solver_residual(run.effort().residual());
    status.set_solver_iterations(run.effort().iterations());
  }
  const ConstraintResidual residual = LargestResidual(run.model(), run.state());
  const auto warnings = StateWarnings(run.model(), run.parameters(), run.state(), residual);
  status.mutable_warnings()->Assign(warnings.begin(), warnings.end());
  if (run.model().constraints.empty()) return;
  status.set_constraint_residual(residual.metres);
  status.set_residual_constraint(std::string(residual.constraint));
}

}  // namespace

void RunningSession::Restore(const v1::SavedMoment& saved) {
  phase = saved.session().state();
  if (saved.session().has_divergence()) run.set_divergence(saved.session().divergence());
  playback.Restore(saved);
  revision = saved.session().revision();
  updates.Restore(saved);
}

v1::Session SessionReporter::status() const {
  v1::Session status = board_.Read();
  status.set_viewers(publisher_.viewers());
  saver_.WriteNotSaved(status);
  return status;
}

void SessionReporter::Report(const RunningSession& session) {
  const ControlState& control = session.control.state();
  reported_control_ = control.revision;
  board_.Write([&](v1::Session& status) { WriteStatus(session, status); },
               std::make_shared<const SessionAccess>(SessionAccess{control.account, control.links}));
  v1::Session status = board_.Read();
  saver_.WriteNotSaved(status);
  publisher_.Announce(status);
  if (saver_.saves()) saver_.SaveChange(MomentOf(session, std::move(status)), session.run.state());
}

void SessionReporter::ReportControl(const RunningSession& session) {
  const ControlBook& control = session.control;
  if (control.state().revision == reported_control_) {
    if (control.state().holder.empty()) return;
    // Not announced: only the holder's time can have changed, by renewal.
    board_.Write([&](v1::Session& status) { *status.mutable_control() = control.Describe(clock_.Now()); });
    return;
  }
  if (!camera_of_.empty() && control.Describe(clock_.Now()).controller() != camera_of_) {
    camera_of_.clear();
    publisher_.ShowCamera(nullptr);
  }
  Report(session);
}

void SessionReporter::ReportProgress(const RunningSession& session, bool measured, absl::Time now) {
  const State& state = session.run.state();
  board_.Write([&](v1::Session& status) {
    status.set_time(state.time);
    status.set_tick(state.tick);
    WriteResiduals(session.run, status);
    if (measured) *status.mutable_pace() = session.meter.pace();
  });
  if (measured) {
    v1::Session status = board_.Read();
    saver_.WriteNotSaved(status);
    publisher_.Announce(status);
  }
  if (saver_.ProgressDue(now)) saver_.SaveProgress(MomentOf(session, status()), state, now);
}

void SessionReporter::ReportEnd(const RunningSession& session) {
  if (!saver_.saves()) return;
  saver_.NoteEnd();
  Report(session);
}

void SessionReporter::OfferFrame(const RunningSession& session, absl::Time now) {
  if (session.run.state().tick == framed_tick_) return;
  framed_tick_ = session.run.state().tick;
  auto snapshot = std::make_shared<stream::Snapshot>();
  snapshot->sequence = ++frames_;
  snapshot->state = session.run.state();
  snapshot->parameters = session.run.parameters();
  snapshot->made = now;
  newest_ = std::move(snapshot);
  publisher_.Offer(newest_);
}

void SessionReporter::NoteReset(const RunningSession& session) {
  sampler_.Restart(session.run.parameters(), session.run.state());
  framed_tick_ = -1;
  saver_.NoteReset();
}

void SessionReporter::ShowCamera(const RunningSession& session, const v1::Camera& camera) {
  camera_of_ = session.control.Describe(clock_.Now()).controller();
  publisher_.ShowCamera(stream::EncodeCamera(camera));
}

void SessionReporter::WriteStatus(const RunningSession& session, v1::Session& status) const {
  const Run& run = session.run;
  status.set_state(session.phase);
  status.set_time(run.state().time);
  status.set_tick(run.state().tick);
  *status.mutable_parameters() = run.parameters();
  status.set_revision(session.revision);
  status.set_speed(session.playback.shown_speed());
  status.set_keep_playing(session.playback.keeps_playing());
  status.set_largest_stable_step(session.stable_step);
  *status.mutable_pace() = session.meter.pace();
  status.set_waiting_updates(session.updates.size());
  *status.mutable_control() = session.control.Describe(clock_.Now());
  *status.mutable_pulls() = DescribePulls(run.model(), run.state().pulls);
  WriteResiduals(run, status);
  if (run.divergence().has_value()) {
    *status.mutable_divergence() = *run.divergence();
  } else {
    status.clear_divergence();
  }
}

v1::SavedMoment SessionReporter::MomentOf(const RunningSession& session, v1::Session status) {
  v1::SavedMoment moment;
  *moment.mutable_session() = std::move(status);
  session.playback.Save(moment);
  *moment.mutable_control() = SaveControl(session.control.state());
  session.updates.Save(moment);
  return moment;
}

}  // namespace phrenic::session
