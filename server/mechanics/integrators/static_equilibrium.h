// The static solve: every step ends where all forces balance, with the bones and muscles as they are then and nothing
// moving; inertia and friction play no part. f(x) = 0 by Newton's method with pseudo-transient continuation (Kelley and
// Keyes 1998): (M/h^2 + K) dx = f with h growing as long as steps stay small, so that it ends as Newton's method. A
// motion of such steps is the quasi-static one; its order is 0, since it is not the dynamic one in any limit.
#ifndef PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_
#define PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_

#include "server/mechanics/integrator.h"

namespace phrenic {

class StaticEquilibrium final : public Integrator {
 public:
  std::string_view name() const override { return "static"; }
  int order() const override { return 0; }
  double MaxStep(const Spectrum& spectrum) const override;
  absl::Status Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                       Workspace& work) const override;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_INTEGRATORS_STATIC_EQUILIBRIUM_H_
