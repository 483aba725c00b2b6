// Harmonic functions on a triangle surface.
#ifndef PHRENIC_SERVER_MESH_HARMONIC_H_
#define PHRENIC_SERVER_MESH_HARMONIC_H_

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// The function with the least gradient that is 0 on the vertices `zero` and 1 on the vertices `one` (Laplace's equation
// with cotangent weights, Pinkall and Polthier 1993): one value a vertex. A vertex in both is 1; vertices that the
// surface joins to neither have no slope. INVALID_ARGUMENT where there is no solution.
absl::StatusOr<Eigen::VectorXd> HarmonicBetween(const Mesh& mesh, const std::vector<bool>& zero,
                                                const std::vector<bool>& one);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_HARMONIC_H_
