// The code that generates meshes.
#ifndef PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_
#define PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_

namespace phrenic::session {

// SHA-256, in hexadecimal, of the libraries anatomy, mesh and schema (which completes a physique). It is equal in all
// programs of a build and differs between versions, compilers and options. Written by
// server/session/mesh_cache/mesh_code.cmake when these libraries are linked.
extern const char kMeshCode[];

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_MESH_CACHE_MESH_CODE_H_
