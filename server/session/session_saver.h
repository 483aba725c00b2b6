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
// and WriteNotSaved; the other methods belong to the stepping thread. Session owns it. The methods hand over what to
// save and do not wait for the disk, except Flush and AwaitCopy; an error of writing appears in these and in
// WriteNotSaved.
class SessionSaver {
 public:
  // `journal` may be null. `clock` outlives the saver.
  SessionSaver(std::shared_ptr<store::Journal> journal, const Clock& clock, bool in_cluster);

  // False if there is no store.
  bool saves() const { return journal_ != nullptr; }
  // Waits until everything saved so far is on the disk. Returns the errors of store::Journal::Flush. Returns OK at once
  // without a journal, as AwaitCopy and CheckLease do.
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
  // The next change is the session's last: it is saved with a state, so that a restart repeats no step.
  void NoteEnd() { ends_ = true; }
  // Saves `moment` with the session's status, and `state`, at which it holds, if a state is due. Requires: saves(). A
  // state is due if none was saved yet, if the last one is of another tick and too old or the session ends, or if too
  // many moments wait (Journal::wants_state). Marks the moment as from the start after NoteReset.
  void SaveChange(v1::SavedMoment moment, const State& state);
  // True if the progress of a playing session is to be saved at `now`. False without a journal.
  bool ProgressDue(absl::Time now) const;
  // The same as SaveChange, for a moment in which only time has changed. The journal keeps only the latest of such
  // moments. Requires: saves().
  void SaveProgress(v1::SavedMoment moment, const State& state, absl::Time now);

 private:
  // True if the last saved state is older than between_states_.
  bool StateIsStale(absl::Time now) const;
  // Copies the state; the journal so far is no longer needed.
  void SaveState(v1::SavedMoment moment, const State& state);

  const std::shared_ptr<store::Journal> journal_;  // null: nothing is saved
  const Clock& clock_;
  const absl::Duration between_states_;                                                    // 2 s; 1 s in a cluster
  absl::Time state_saved_ = absl::InfinitePast(), progress_saved_ = absl::InfinitePast();  // on the wall clock
  std::int64_t saved_tick_ = -1;                                                           // of the last saved state
  std::int64_t saved_revision_ = 0, saved_control_ = 0;                                    // of the last saved change
  bool from_start_ = false;  // reset since the last saved change
  bool ends_ = false;        // NoteEnd was called
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SESSION_SAVER_H_
