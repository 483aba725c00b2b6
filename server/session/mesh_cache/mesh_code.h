// The code that generates meshes.
#ifndef PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_
#define PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_

namespace phrenic::session {

// SHA-256 of the libraries anatomy, mesh and schema, which completes a physique, in hexadecimal: all programs of a
// build have the same, and those of another version, compiler or option another one. Written by
// server/session/mesh_cache/mesh_code.cmake when these are linked.
extern const char kMeshCode[];

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_
