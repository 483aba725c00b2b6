// Generates the parts of a scene on all cores, ahead of a compile that asks for one after another.
#ifndef PHRENIC_SERVER_SESSION_MESH_CACHE_MESHES_AHEAD_H_
#define PHRENIC_SERVER_SESSION_MESH_CACHE_MESHES_AHEAD_H_

#include "server/mechanics/compile/mesh_source.h"

namespace phrenic::session {

// Returns a source with the meshes of `source`. The first call for a generated body of the scene starts up to
// `threads` - 1 threads, which take the scene's generated parts from `source`, those with the most vertices first; the
// caller takes parts while it waits for its own. Equal parts are generated once. Errors are returned when their body is
// asked for, so that they do not depend on the number of threads. Other bodies are passed on to `source`. Thread-safe;
// requires that `source` is. The threads end with the last copy, each after the part that it generates.
MeshSource MeshesAhead(const v1::Scene& scene, MeshSource source, int threads);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESH_CACHE_MESHES_AHEAD_H_
