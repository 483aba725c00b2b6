#include "server/mechanics/integrators/explicit_euler.h"

#include <algorithm>
#include <limits>

#include "server/mechanics/step/step_plan.h"

namespace phrenic {

double ExplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const double omega2 = spectrum.omega_max * spectrum.omega_max;
  return std::min(omega2 > 0 ? spectrum.least_damping_rate / omega2 : infinity,
                  spectrum.damping_rate > 0 ? 2 / spectrum.damping_rate : infinity);
}

absl::Status ExplicitEuler::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                                    Workspace& work) const {
  const Eigen::VectorXd& inverse_mass = plan.model().inverse_mass;
  plan.SumForces(plan.ContextAhead(parameters, 0, state, work.scratch), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (inverse_mass[i] == 0) continue;  // fixed or driven
    state.x.col(i) += dt * state.v.col(i);
    state.v.col(i) += dt * inverse_mass[i] * work.force.col(i);
  }
  plan.DriveMotions(parameters, dt, work.scratch, state);
  plan.ProjectPositions(parameters, work.before, dt, work.scratch, state);
  return absl::OkStatus();
}

}  // namespace phrenic
