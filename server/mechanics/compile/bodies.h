// The first half of the compile step: bodies, their meshes, places in the state, and masses.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_

#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Fills bodies, rest, mass, inverse_mass, fixed_vertices and size from builder.model.scene.
absl::Status AddBodies(const MeshSource& source, ModelBuilder& builder);

// Fills the probes; bodies are there.
absl::Status AddProbes(ModelBuilder& builder);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
