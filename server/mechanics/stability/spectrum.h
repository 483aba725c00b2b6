// The fastest vibration of a model, which limits explicit steps: omega_max^2 is the largest eigenvalue of M^-1 K.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_

#include "server/mechanics/model.h"

namespace phrenic {

// The fastest mode, or the one that limits the step of an integrator that counts damping (Integrator::counted_damping).
struct FastestMode {
  Spectrum spectrum;
  int vertex = -1;  // with the largest displacement; -1 if nothing vibrates
  Points mode;      // displacements, 3 x n, the largest of length 1; no columns if nothing vibrates
};

// Lanczos iteration on M^-1/2 K M^-1/2 at the state, K positive semi-definite, including inactive contacts and slack
// cables (latent stiffness): 20 products, plus the residual of the largest Ritz value, which makes it an upper bound of
// the eigenvalue found (estimated over true omega: 0.985-1.008). Reorthogonalises once a Ritz vector converges. If
// damping counts, the matrix is K + (2/dt) C with dt near the resulting largest step: the largest eigenvalue of dt^2 K
// + 2 dt C is then 4. In that case eight of the products are of K alone, for a first dt and start vector. Deterministic
// and thread-safe.
FastestMode FindFastestMode(const Model& model, const v1::Parameters& parameters, const State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_
