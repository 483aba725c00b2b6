// A session as its store has it, and back.
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
#include "server/store/layout.h"

namespace phrenic::session {

v1::SavedControl SaveControl(const ControlState& state);
ControlState RestoreControl(const v1::SavedControl& saved);

// What is compiled of a scene, and the files that clients gave for it.
struct Compiled {
  std::shared_ptr<const Model> model;
  std::vector<Uploads::Held> surfaces;
};

// Complete in itself. The errors of reading the files.
absl::StatusOr<v1::SavedScene> SaveScene(const Model& model, const std::vector<Uploads::Held>& surfaces);
// FAILED_PRECONDITION, which begins with `what`, where the scene does not come out as it was.
absl::StatusOr<Compiled> RestoreScene(const v1::SavedScene& saved, const std::string& what, Models& models);

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
