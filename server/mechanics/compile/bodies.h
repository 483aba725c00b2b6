// The first half of the compile step: bodies, their meshes, places in the state, and masses.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_

#include "server/mechanics/compile/compile.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Fills bodies, rest, mass, inverse_mass, fixed_vertices and size from draft.model.scene.
absl::Status AddBodies(const MeshSource& source, Draft& draft);

// Fills the probes; bodies are there.
absl::Status AddProbes(Draft& draft);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_BODIES_H_
