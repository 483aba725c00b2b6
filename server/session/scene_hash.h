// An identifier of a compiled scene: equal scenes and meshes have equal hashes, and hence equal motions.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_

#include <string>

#include "server/mechanics/model.h"

namespace phrenic {

// Returns the SHA-256, in hexadecimal, of the serialized scene and each body's vertices, triangles and edges.
std::string SceneHash(const Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SCENE_HASH_H_
