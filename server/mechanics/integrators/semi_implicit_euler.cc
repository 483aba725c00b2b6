#include "server/mechanics/integrators/semi_implicit_euler.h"

#include <cmath>
#include <limits>

#include "server/mechanics/advance.h"

namespace phrenic {

double SemiImplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double omega2 = spectrum.omega_max * spectrum.omega_max, c = spectrum.damping_rate;
  if (omega2 == 0) return c > 0 ? 2 / c : std::numeric_limits<double>::infinity();
  return 4 / (c + std::sqrt(c * c + 4 * omega2));
}

absl::Status SemiImplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  DriveMotions(model, parameters, dt, state);
  SumForces(model, MakeInstant(model, parameters, state), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;  // fixed, or set by a motion
    state.v.col(i) += dt * model.inverse_mass[i] * work.force.col(i);
    state.x.col(i) += dt * state.v.col(i);
  }
  ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
