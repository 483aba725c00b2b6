// Harmonic functions on a triangle surface: solutions of Laplace's equation, discretised with cotangent weights
// (Pinkall and Polthier, Computing Discrete Minimal Surfaces and Their Conjugates, 1993).
#ifndef PHRENIC_SERVER_MESH_HARMONIC_H_
#define PHRENIC_SERVER_MESH_HARMONIC_H_

#include "absl/status/statusor.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// Returns the harmonic function u (one value per vertex) with Dirichlet values u = 0 where `zero[i]` and u = 1 where
// `one[i]`; a vertex in both has 1. Components without a Dirichlet vertex have u = 0. INVALID_ARGUMENT if the linear
// system cannot be factorised or its solution is not finite.
absl::StatusOr<Eigen::VectorXd> HarmonicBetween(const Mesh& mesh, const std::vector<bool>& zero,
                                                const std::vector<bool>& one);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_HARMONIC_H_
