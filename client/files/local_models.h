// Scenes that a command compiles in this process.
#ifndef PHRENIC_CLIENT_FILES_LOCAL_MODELS_H_
#define PHRENIC_CLIENT_FILES_LOCAL_MODELS_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/connection/context.h"
#include "server/session/models.h"

namespace phrenic::client {

// Returns the models of the installed scenes and of those in DATA/scenes, with the generated meshes that this machine
// keeps. An empty folder: the installed scenes alone.
session::Models LocalModels(const std::string& data_dir);

// Compiles a scene, which the progress bar calls `name`. The errors of session::Models::Get; CANCELLED after Ctrl-C.
absl::StatusOr<std::shared_ptr<const Model>> CompileLocally(const Context& context, const v1::SceneSource& source,
                                                            const std::string& name, const std::string& data_dir);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_LOCAL_MODELS_H_
