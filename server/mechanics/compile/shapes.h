// The shapes that a scene writes out itself: polyhedra and grids.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/compile/mesh_source.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// The mesh of a body, checked; files and generated parts come from `source`. Errors name the body.
absl::StatusOr<Mesh> MakeShape(const v1::Body& body, const MeshSource& source);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_
