// The lungs of a scene, for fits to people.
#ifndef PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
#define PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/cli/scene_argument.h"
#include "server/fit/person.h"

namespace phrenic::client {

// Returns the surfaces of the bodies with the anatomy of a right and a left lung, generated or read from files below
// `data_dir`. FAILED_PRECONDITION if the scene lacks one, or a surface is not closed; the errors of ReadScene and of
// session::MakeMeshSource.
absl::StatusOr<fit::LungTemplates> ReadSceneLungs(const SceneOptions& options, const std::string& data_dir);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_SCENE_LUNGS_H_
