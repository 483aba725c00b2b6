#include "server/mechanics/integrators/explicit_euler.h"

#include <algorithm>
#include <limits>

#include "server/mechanics/step/advance.h"

namespace phrenic {

double ExplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const double omega2 = spectrum.omega_max * spectrum.omega_max;
  return std::min(omega2 > 0 ? spectrum.least_damping_rate / omega2 : infinity,
                  spectrum.damping_rate > 0 ? 2 / spectrum.damping_rate : infinity);
}

absl::Status ExplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                    Workspace& work) const {
  SumForces(model, MakeEvalContext(model, parameters, state), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (model.inverse_mass[i] == 0) continue;  // fixed, or set by a motion
    state.x.col(i) += dt * state.v.col(i);
    state.v.col(i) += dt * model.inverse_mass[i] * work.force.col(i);
  }
  DriveMotions(model, parameters, dt, state);
  ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
