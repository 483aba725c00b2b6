// Converts a session to what its store keeps, and back.
#ifndef PHRENIC_SERVER_SESSION_SAVING_H_
#define PHRENIC_SERVER_SESSION_SAVING_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/model.h"
#include "server/session/control.h"
#include "server/session/models.h"
#include "server/session/run.h"
#include "server/store/layout.h"

namespace phrenic::session {

// Tokens are saved as they are, so that people stay in the session after a restart.
v1::SavedControl SaveControl(const ControlState& state);
ControlState RestoreControl(const v1::SavedControl& saved);

// Returns the scene with the content of its uploaded files and the layout of its states. The errors of reading the
// files. Rest positions are saved as little-endian float32 [m], 3 per vertex.
absl::StatusOr<v1::SavedScene> SaveScene(const Model& model, const std::vector<Uploads::Held>& surfaces);
// Compiles a saved scene, whose files belong to `owner`. The errors of Models::Restore. Sets `same` by comparing scene
// hashes; a difference is no error.
absl::StatusOr<Compiled> CompileSaved(const v1::SavedScene& saved, const std::string& owner, Models& models);
// The same. FAILED_PRECONDITION, which begins with `what`, if the model differs from the saved one.
absl::StatusOr<Compiled> RestoreScene(const v1::SavedScene& saved, const std::string& what, const std::string& owner,
                                      Models& models);

// The last moment of a saved session.
struct Replayed {
  State state;
  v1::SavedMoment moment;         // the last in its journal
  std::string carried_over = {};  // v1::Session.carried_over
};

// Takes the steps and changes of a journal from `run`, which is at the first moment. DATA_LOSS as Replay. The calling
// thread steps until the tick of the last moment.
absl::Status ReplayJournal(const std::vector<v1::SavedMoment>& later, Run& run);
// Returns the parameters of a saved session; those that its build did not have are the model's. Every field of the
// result is set if those of the model are.
v1::Parameters SavedParameters(const Model& model, const v1::Parameters& saved);

// Replays a saved session: starts from its saved state, and takes the steps and changes of its journal. The result
// equals the session's last state bit for bit. Requires: `model` is the model of the session. DATA_LOSS if the state
// does not fit the model, or if the journal cannot be replayed.
absl::StatusOr<Replayed> Replay(std::shared_ptr<const Model> model, const store::SavedSession& saved);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SAVING_H_
