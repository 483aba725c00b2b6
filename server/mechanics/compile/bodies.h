// The first part of the compile step: bodies with their meshes, indices in the state and masses; and probes.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_

#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/compile/scene_size.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Fills bodies, rest, mass, inverse_mass, fixed_vertices, size and bound of builder.model from its scene, and reports
// the bodies. INVALID_ARGUMENT "bodies[2].name: ..." for invalid bodies; errors of `source` are passed on. The errors
// of CountSize as soon as the meshes exceed the limits, before any element is made of them.
absl::Status AddBodies(const MeshSource& source, const SizeLimits& limits, ModelBuilder& builder);

// Fills the probes. Requires: AddBodies. INVALID_ARGUMENT "probes[0].body: ..." if a body or vertex does not exist.
absl::Status AddProbes(ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
