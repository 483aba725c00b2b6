// When a session is saved, and what of it.
#ifndef PHRENIC_SERVER_SESSION_SESSION_SAVER_H_
#define PHRENIC_SERVER_SESSION_SESSION_SAVER_H_

#include <cstdint>
#include <memory>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/state.h"
#include "server/schema/clock.h"
#include "server/store/store.h"

namespace phrenic::session {

// Writes to the session's journal each change with its tick, the progress of a playing session every half second, and
// a state every two seconds (every second in a cluster), so that a restored session steps again through two seconds of
// its past at most. Without a journal nothing is saved. Any thread may call saves, Flush, AwaitCopy, CheckLease, Forget
// and WriteNotSaved; the other methods belong to the stepping thread.
class SessionSaver {
 public:
  // `journal` may be null.
  SessionSaver(std::shared_ptr<store::Journal> journal, const Clock& clock, bool in_cluster);

  bool saves() const { return journal_ != nullptr; }
  // Waits until everything saved so far is on the disk. Returns the errors of store::Journal::Flush.
  absl::Status Flush(store::Durability durability) const;
  // The same as store::Journal::AwaitCopy and CheckLease.
  absl::Status AwaitCopy() const;
  absl::Status CheckLease() const;
  // Removes the session from the store.
  void Forget() const;
  // Fills `not_saved`: why the last attempt to write failed, or empty.
  void WriteNotSaved(v1::Session& status) const;

  // The next change begins at t = 0.
  void NoteReset() { from_start_ = true; }
  // Saves `moment` with the session's status, and `state`, at which it holds, if a state is due. Requires: saves().
  void SaveChange(v1::SavedMoment moment, const State& state);
  // True if the progress of a playing session is to be saved at `now`.
  bool ProgressDue(absl::Time now) const;
  // The same as SaveChange, for a moment in which only time has changed.
  void SaveProgress(v1::SavedMoment moment, const State& state, absl::Time now);

 private:
  bool StateIsStale(absl::Time now) const;
  void SaveState(v1::SavedMoment moment, const State& state);

  const std::shared_ptr<store::Journal> journal_;
  const Clock& clock_;
  const absl::Duration between_states_;
  absl::Time state_saved_ = absl::InfinitePast(), progress_saved_ = absl::InfinitePast();
  std::int64_t saved_tick_ = -1;                         // of the last saved state
  std::int64_t saved_revision_ = 0, saved_control_ = 0;  // of the last saved change
  bool from_start_ = false;                              // reset since the last saved change
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SESSION_SAVER_H_
