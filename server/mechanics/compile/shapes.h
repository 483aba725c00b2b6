// Meshes of the shapes that a scene defines: polyhedron, grid, block, filling (a surface filled with tetrahedra) and
// ellipsoid.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/stop_check.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the validated mesh of a body. `source` provides those of files and generators. Errors name the body; the
// status of `stop` once it has stopped.
absl::StatusOr<Mesh> MakeShape(const v1::Body& body, const MeshSource& source, const StopCheck& stop);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_SHAPES_H_
