// The name of a motion: same scene and meshes, same hash, same motion.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_

#include <string>

#include "server/mechanics/model.h"

namespace phrenic {

// SHA-256 over the scene's message and every body's vertices, triangles and edges, in hexadecimal.
std::string SceneHash(const Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_
