// An identifier of a compiled scene: equal scenes and meshes have equal hashes, and hence equal motions.
#ifndef PHRENIC_SERVER_SESSION_SCENE_HASH_H_
#define PHRENIC_SERVER_SESSION_SCENE_HASH_H_

#include <string>

#include "server/mechanics/model.h"

namespace phrenic::session {

// Returns the SHA-256, in hexadecimal, of the serialized scene and each body's vertices, triangles and edges.
// Thread-safe. Numbers are hashed as they lie in memory. A restarted server compares the hash with the saved one
// (CompileSaved).
std::string SceneHash(const Model& model);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_SCENE_HASH_H_
