// The fastest vibration of a model: omega_max^2 = largest eigenvalue of M^-1 K, which limits explicit steps.
#ifndef PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_
#define PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_

#include "server/mechanics/model.h"

namespace phrenic {

// The fastest, or, for an integrator that each mode's own damping holds back, the one that limits its step.
struct FastestMode {
  Spectrum spectrum;
  int vertex = -1;  // where the mode is largest; -1 where nothing vibrates
  Points mode;      // its displacements, 3 x n, the largest of length 1; no columns where nothing vibrates
};

// Lanczos on M^-1/2 K M^-1/2 in the state, K positive semi-definite, with what may yet wake (latent stiffness): 20
// products, plus the residual of the largest Ritz value, which makes it an upper bound of the eigenvalue it found
// (estimates over true omega: 0.985-1.008). Reorthogonalised as soon as a Ritz vector converges. Where damping counts
// (Integrator::counted_damping), for K + (2/dt) C, dt near the largest step that it gives: of dt^2 K + 2 dt C the
// largest eigenvalue is then 4. Eight of the products are K's alone then, for a first dt and a start. Deterministic.
FastestMode FindFastestMode(const Model& model, const v1::Parameters& parameters, const State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STABILITY_SPECTRUM_H_
