#include "server/mechanics/integrators/thesis_euler.h"

#include "server/mechanics/integrators/semi_implicit_euler.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr double kDamping = 0.02;  // [kg] a step: "an experimentally chosen constant"

}  // namespace

// Each step multiplies velocities and forces by 1 - 0.02/m. Below 0.02 kg that reverses the sign of spring forces, and
// below 0.01 kg it makes free motion grow; above, it raises semi-implicit Euler's limit a little.
double ThesisEuler::MaxStep(const Spectrum& spectrum) const {
  const double least = spectrum.omega_max > 0 ? kDamping : kDamping / 2;
  return spectrum.least_mass < least ? 0 : SemiImplicitEuler().MaxStep(spectrum);
}

absl::Status ThesisEuler::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                                  Workspace& work) const {
  const Eigen::VectorXd& inverse_mass = plan.model().inverse_mass;
  plan.DriveMotions(parameters, dt, work.scratch, state);
  plan.SumForces(plan.ContextAhead(parameters, 0, state, work.scratch), work.force);
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (inverse_mass[i] == 0) continue;  // fixed or driven
    state.v.col(i) += dt * inverse_mass[i] * work.force.col(i);
    state.v.col(i) -= kDamping * inverse_mass[i] * state.v.col(i);
    state.x.col(i) += dt * state.v.col(i);
  }
  plan.ProjectPositions(parameters, work.before, dt, work.scratch, state);
  return absl::OkStatus();
}

}  // namespace phrenic
