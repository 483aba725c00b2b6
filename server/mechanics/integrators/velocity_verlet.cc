#include "server/mechanics/integrators/velocity_verlet.h"

#include <limits>

#include "server/mechanics/damping.h"
#include "server/mechanics/integrators/semi_implicit_euler.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

// Sets `force` to that at the start of the step: that of the end of the last one, or computed anew.
void RecallForce(const StepPlan& plan, const v1::Parameters& parameters, const State& state, const Scratch& scratch,
                 Points& force) {
  const History& history = state.history;
  if (history.integrator == v1::INTEGRATOR_VELOCITY_VERLET && history.tick == state.tick) {
    force = history.force;
  } else {
    plan.SumForces(plan.ContextAhead(parameters, 0, state, scratch), force);
  }
}

void RememberForce(const Points& half, const Workspace& work, State& state) {
  History& history = state.history;
  history.force = work.force - (state.v - half) * work.damping.asDiagonal();
  if (!work.shared_damping.empty()) work.shared_damping.AddTimes(-1, state.v - half, history.force);
  history.integrator = v1::INTEGRATOR_VELOCITY_VERLET;
  history.tick = state.tick + 1;
}

// Solves v' = v + dt/2 f(x', v')/m for v'. The force in `work` is that of v; f is linear in v' by the damping in
// `work`.
void KickImplicitly(const StepPlan& plan, double dt, Workspace& work, Points& v) {
  const Eigen::VectorXd& inverse_mass = plan.model().inverse_mass;
  const auto inverse = [&](const Points& right, Points& left) {
    left.resize(3, right.cols());
    for (Eigen::Index i = 0; i < right.cols(); ++i) {
      const double w = inverse_mass[i];
      left.col(i) = dt / 2 * w / (1 + dt / 2 * w * work.damping[i]) * right.col(i);
    }
  };
  Points& change = work.Stage(0);
  inverse(work.force, change);
  work.shared_damping.Correct(1, inverse, change);
  plan.AddToFree(1, change, v);
}

}  // namespace

// Viscosity acts with the velocities of half a step before, as in semi-implicit Euler; other damping is implicit.
double VelocityVerlet::MaxStep(const Spectrum& spectrum) const {
  if (spectrum.viscous_rate > 0) {
    return SemiImplicitEuler().MaxStep({.omega_max = spectrum.omega_max, .damping_rate = spectrum.viscous_rate});
  }
  return spectrum.omega_max > 0 ? 2 / spectrum.omega_max : std::numeric_limits<double>::infinity();
}

absl::Status VelocityVerlet::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                                     Workspace& work) const {
  RecallForce(plan, parameters, state, work.scratch, work.force);
  KickAndDrift({0, state.x.cols()}, plan.model().inverse_mass, dt / 2, dt, work.force, {}, state.x, state.v, state.x,
               state.v);
  plan.DriveMotions(parameters, dt, work.scratch, state);
  plan.ProjectPositions(parameters, work.before, dt, work.scratch, state);
  const EvalContext end = plan.ContextAhead(parameters, dt, state, work.scratch);
  plan.SumForces(end, work.force);
  SumDamping(plan.model(), end, work.damping);
  SumSharedDamping(plan.model(), end, work.shared_damping);
  Points& half = work.Stage(1);
  half = state.v;
  KickImplicitly(plan, dt, work, state.v);
  plan.ProjectVelocities(parameters, work.scratch, state);
  RememberForce(half, work, state);
  return absl::OkStatus();
}

}  // namespace phrenic
