// The source of meshes from files and generators, passed to the compile step.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_MESH_SOURCE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_MESH_SOURCE_H_

#include <functional>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the mesh of a body with a file, a generated part or a derived surface. Errors name the body.
using MeshSource = std::function<absl::StatusOr<Mesh>(const v1::Body& body)>;

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_MESH_SOURCE_H_
