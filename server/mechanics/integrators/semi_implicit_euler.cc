#include "server/mechanics/integrators/semi_implicit_euler.h"

#include <cmath>
#include <limits>

#include "server/mechanics/advance.h"
#include "server/mechanics/vertex_kernel.h"

namespace phrenic {

double SemiImplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double omega2 = spectrum.omega_max * spectrum.omega_max, c = spectrum.damping_rate;
  if (omega2 == 0) return c > 0 ? 2 / c : std::numeric_limits<double>::infinity();
  return 4 / (c + std::sqrt(c * c + 4 * omega2));
}

absl::Status SemiImplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  DriveMotions(model, parameters, dt, state);
  const Instant at = MakeInstant(model, parameters, state);
  SumWholeForces(model, at, work.force);
  ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
    SumForcesIn(block, model, at, work.force);
    KickAndDrift(block, model.inverse_mass, dt, dt, work.force, state.x, state.v, work.next);
  });
  state.x.swap(work.next);
  ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
