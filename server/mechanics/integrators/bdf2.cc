#include "server/mechanics/integrators/bdf2.h"

#include <algorithm>
#include <limits>

#include "server/mechanics/integrators/tr_bdf2.h"
#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

bool HasStepBefore(const State& state, double dt) {
  const History& history = state.history;
  return history.integrator == v1::INTEGRATOR_BDF2 && history.tick == state.tick && history.dt == dt;
}

absl::Status AdvanceFromTwo(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                            Workspace& work) {
  work.stages.resize(std::max<size_t>(work.stages.size(), 3));
  Points &position = work.stages[1], &velocity = work.stages[2];
  position = (4 * work.before - state.history.x) / 3;
  velocity = (4 * work.velocity_before - state.history.v) / 3;
  state.v = 2 * work.velocity_before - state.history.v;  // a first guess
  const ImplicitStage stage{dt, 2 * dt / 3, position, velocity, kNewtonSteps};
  if (absl::Status solved = SolveStage(model, parameters, stage, state, work); !solved.ok()) return solved;
  ProjectPositions(model, parameters, work.before, dt, state);
  ProjectVelocities(model, parameters, state);
  return absl::OkStatus();
}

}  // namespace

double Bdf2::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status Bdf2::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                           Workspace& work) const {
  absl::Status advanced = HasStepBefore(state, dt) ? AdvanceFromTwo(model, parameters, dt, state, work)
                                                   : TrBdf2().Advance(model, parameters, dt, state, work);
  if (!advanced.ok()) return advanced;
  History& history = state.history;
  history.integrator = v1::INTEGRATOR_BDF2;
  history.tick = state.tick + 1;
  history.dt = dt;
  history.x = work.before;
  history.v = work.velocity_before;
  return absl::OkStatus();
}

}  // namespace phrenic
