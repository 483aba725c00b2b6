#include "server/mechanics/integrators/bdf2.h"

#include <limits>

#include "server/mechanics/integrators/tr_bdf2.h"
#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

bool HasStepBefore(const State& state, double dt) {
  const History& history = state.history;
  return history.integrator == v1::INTEGRATOR_BDF2 && history.tick == state.tick && history.dt == dt;
}

absl::Status AdvanceFromTwo(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                            Workspace& work) {
  Points &position = work.Stage(1), &velocity = work.Stage(2);
  position = (4 * work.before - state.history.x) / 3;
  velocity = (4 * work.velocity_before - state.history.v) / 3;
  state.v = 2 * work.velocity_before - state.history.v;  // first guess
  const ImplicitStage stage{dt, 2 * dt / 3, position, velocity, kNewtonSteps};
  if (absl::Status solved = SolveStage(plan, parameters, stage, state, work); !solved.ok()) return solved;
  ProjectStage(plan, parameters, stage, work.before, work, state);
  return absl::OkStatus();
}

// False if a length limit was reached or released in the step, or a projection moves positions after each: the step
// before is then not one of the same motion.
bool IsSmooth(const StepPlan& plan, const v1::Parameters& parameters, const State& state, Workspace& work) {
  for (const auto& constraint : plan.model().constraints) {
    if (parameters.apply_links() && !constraint->SameMotion(work.before, state.x)) return false;
  }
  return true;
}

}  // namespace

double Bdf2::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status Bdf2::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt, State& state,
                           Workspace& work) const {
  absl::Status advanced = HasStepBefore(state, dt) ? AdvanceFromTwo(plan, parameters, dt, state, work)
                                                   : TrBdf2().Advance(plan, parameters, dt, state, work);
  if (!advanced.ok()) return advanced;
  History& history = state.history;
  history.integrator = IsSmooth(plan, parameters, state, work) ? v1::INTEGRATOR_BDF2 : v1::INTEGRATOR_UNSPECIFIED;
  history.tick = state.tick + 1;
  history.dt = dt;
  history.x = work.before;
  history.v = work.velocity_before;
  return absl::OkStatus();
}

}  // namespace phrenic
