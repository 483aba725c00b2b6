// Scenes as text files.
#ifndef PHRENIC_CLIENT_FILES_SCENE_TEXT_H_
#define PHRENIC_CLIENT_FILES_SCENE_TEXT_H_

#include <string>

#include "phrenic/v1/scene.pb.h"

namespace phrenic::client {

// Returns a scene's file. `comment`: lines for its head without "#"; empty: none.
std::string SceneText(const v1::Scene& scene, const std::string& comment = "");

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_SCENE_TEXT_H_
