// Scene -> Model: only what the scene needs, and a report of what runs, what was left out and why.
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_

#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "server/mechanics/model.h"

namespace phrenic {

// Gives the mesh of a body with a file or a generated shape; the other shapes the compile step makes itself.
using MeshSource = std::function<absl::StatusOr<Mesh>(const v1::Body& body)>;

// INVALID_ARGUMENT names the field, "forces[2].springs.bodies[0]: there is no body or layer \"lnug\"; there are ...".
absl::StatusOr<std::shared_ptr<const Model>> Compile(const v1::Scene& scene, const MeshSource& source);

// The largest stable step of the model under these parameters (Lanczos, with a safety factor), and its reason.
v1::StableStep LargestStableStep(const Model& model, const v1::Parameters& parameters);

// The step to start with where nobody has named one: 0.9 of the largest stable one in two digits, a 60th of a second at
// most [s].
double ChosenStep(const v1::StableStep& stable);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_COMPILE_H_
