// A session as its store has it, and back.
#ifndef PHRENIC_SERVER_SESSION_SAVING_H_
#define PHRENIC_SERVER_SESSION_SAVING_H_

#include <memory>

#include "absl/status/statusor.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/model.h"
#include "server/session/control.h"
#include "server/store/layout.h"

namespace phrenic::session {

v1::SavedControl SaveControl(const ControlState& state);
ControlState RestoreControl(const v1::SavedControl& saved);

// Where a saved session stands.
struct Replayed {
  State state;
  v1::SavedMoment moment;  // the last that it was told
};

// Takes the state from disk, and steps and changes it as it was then: bit for bit the state that the session had, where
// the model is the same. DATA_LOSS where the state is none of the model, or stops short.
absl::StatusOr<Replayed> Replay(std::shared_ptr<const Model> model, const store::SavedSession& saved);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SAVING_H_
