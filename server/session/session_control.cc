// Who may change a session, as its stepping thread has it.
#include <utility>

#include "server/session/session.h"
#include "server/stream/encoder.h"

namespace phrenic::session {

absl::Status Session::AskAs(std::string_view token, absl::FunctionRef<absl::Status()> act) {
  absl::Status done;
  auto asked = Ask([&] {
    done = control_.Check(token, clock_.Now());
    if (done.ok()) done = act();
  });
  return asked.ok() ? done : asked;
}

std::shared_ptr<const Session::Access> Session::access() const {
  absl::MutexLock lock(&mutex_);
  return access_;
}

void Session::Rest() {
  (void)Ask([this] {
    EndJob(absl::AbortedError("the session was paused, as nobody watched it"));
    if (state_ == v1::SESSION_STATE_PLAYING) Halt(v1::SESSION_STATE_PAUSED);
  });
}

absl::Status Session::CheckControl(std::string_view token) {
  return AskAs(token, [] { return absl::OkStatus(); });
}

absl::StatusOr<v1::Control> Session::ChangeControl(
    absl::FunctionRef<absl::Status(ControlBook& book, absl::Time now)> act) {
  absl::Status changed;
  v1::Control control;
  auto asked = Ask([&] {
    changed = act(control_, clock_.Now());
    NoteControl();
    control = control_.Describe(clock_.Now());
  });
  if (!asked.ok()) return asked;
  if (!changed.ok()) return changed;
  if (const auto saved = Saved(); !saved.ok()) return saved.status();
  return control;
}

absl::Status Session::ShowCamera(const v1::Camera& camera, std::string_view token) {
  absl::Status shown;
  auto asked = Ask([&] {
    shown = control_.CheckAlone(token, clock_.Now());
    NoteControl();
    if (!shown.ok()) return;
    camera_of_ = control_.Describe(clock_.Now()).controller();
    publisher_.ShowCamera(stream::EncodeCamera(camera));
  });
  return asked.ok() ? shown : asked;
}

void Session::NoteControl() {
  if (control_.state().revision == told_control_) {
    if (control_.state().holder.empty()) return;
    absl::MutexLock lock(&mutex_);
    *status_.mutable_control() = control_.Describe(clock_.Now());  // it may have been renewed, which is no news
    return;
  }
  if (!camera_of_.empty() && control_.Describe(clock_.Now()).controller() != camera_of_) {
    camera_of_.clear();
    publisher_.ShowCamera(nullptr);
  }
  Tell();
}

}  // namespace phrenic::session
