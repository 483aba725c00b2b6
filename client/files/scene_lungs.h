// The lungs of a scene, for fits to people.
#ifndef PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
#define PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_

#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"
#include "server/fit/scene_lungs.h"

namespace phrenic::client {

// Returns the scene's lungs, generated or read from files below `data_dir`. The errors of session::Models::Resolve,
// session::MakeMeshSource and fit::MakeSceneLungs.
absl::StatusOr<fit::SceneLungs> ReadSceneLungs(const v1::SceneSource& scene, const std::string& data_dir);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
