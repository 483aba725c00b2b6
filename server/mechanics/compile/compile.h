// Compiles a Scene into a Model that contains only the elements the scene needs, with a report of what runs, what was
// left out and why.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "server/mechanics/compile/mesh_source.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Thread-safe if `source` is. Errors of `source` are passed on; INVALID_ARGUMENT names the field:
// "forces[2].springs.bodies[0]: there is no body or layer \"lnug\"; there are ...".
absl::StatusOr<std::shared_ptr<const Model>> Compile(const v1::Scene& scene, const MeshSource& source);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
