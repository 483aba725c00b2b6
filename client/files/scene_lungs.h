// The lungs of a scene, for fits to people.
#ifndef PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
#define PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"
#include "server/fit/person.h"

namespace phrenic::client {

struct SceneLungs {
  std::array<v1::Body, 2> bodies;  // by fit::Side
  fit::LungTemplates templates;    // their surfaces
};

// Returns the bodies with the anatomy of a right and a left lung, generated or read
// from files below `data_dir`. FAILED_PRECONDITION if the scene lacks one, or a surface is not closed; the errors of
// session::Models::Resolve and session::MakeMeshSource.
absl::StatusOr<SceneLungs> ReadSceneLungs(const v1::SceneSource& scene, const std::string& data_dir);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
