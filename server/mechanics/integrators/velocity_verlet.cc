#include "server/mechanics/integrators/velocity_verlet.h"

#include <limits>

#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

// The force at the start of the step: that of the end of the last one, or worked out anew.
void RecallForce(const Model& model, const v1::Parameters& parameters, const State& state, Points& force) {
  const History& history = state.history;
  if (history.integrator == v1::INTEGRATOR_VELOCITY_VERLET && history.tick == state.tick) {
    force = history.force;
  } else {
    SumForces(model, MakeEvalContext(model, parameters, state), force);
  }
}

// v' = v + dt/2 f(x', v')/m, where f has been worked out with v and holds -c v: linear in v', so solved at once.
void KickImplicitly(const Model& model, double dt, const Eigen::VectorXd& damping, OuterProducts& shared,
                    const Points& force, Points& v) {
  const auto inverse = [&](const Points& right, Points& left) {
    left.resize(3, right.cols());
    for (Eigen::Index i = 0; i < right.cols(); ++i) {
      const double w = model.inverse_mass[i];
      left.col(i) = dt / 2 * w / (1 + dt / 2 * w * damping[i]) * right.col(i);
    }
  };
  thread_local Points change;
  inverse(force, change);
  shared.Correct(1, inverse, change);
  AddToFree(model, 1, change, v);
}

}  // namespace

double VelocityVerlet::MaxStep(const Spectrum& spectrum) const {
  return spectrum.omega_max > 0 ? 2 / spectrum.omega_max : std::numeric_limits<double>::infinity();
}

absl::Status VelocityVerlet::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                     Workspace& work) const {
  RecallForce(model, parameters, state, work.force);
  KickAndDrift({0, state.x.cols()}, model.inverse_mass, dt / 2, dt, work.force, {}, state.x, state.v, state.x, state.v);
  DriveMotions(model, parameters, dt, state);
  ProjectPositions(model, parameters, work.before, dt, state);
  const EvalContext end = EvalContextAhead(model, parameters, dt, state);
  SumForces(model, end, work.force);
  SumDamping(model, end, work.damping);
  Points& half = state.history.v;
  half = state.v;
  thread_local OuterProducts shared;
  SumSharedDamping(model, end, shared);
  KickImplicitly(model, dt, work.damping, shared, work.force, state.v);
  ProjectVelocities(model, parameters, state);
  state.history.force = work.force - (state.v - half) * work.damping.asDiagonal();
  if (!shared.empty()) shared.AddTimes(-1, state.v - half, state.history.force);
  state.history.integrator = v1::INTEGRATOR_VELOCITY_VERLET;
  state.history.tick = state.tick + 1;
  return absl::OkStatus();
}

}  // namespace phrenic
