#include "server/mechanics/integrators/linear_implicit_euler.h"

#include <limits>

#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {

double LinearImplicitEuler::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status LinearImplicitEuler::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt,
                                          State& state, Workspace& work) const {
  state.v.setZero();  // forces and stiffness are those at the start of the step
  const ImplicitStage stage{.ahead = dt,
                            .g = dt,
                            .position = work.before,
                            .velocity = work.velocity_before,
                            .newton_steps = 1,
                            .guess = &work.velocity_before};
  if (absl::Status solved = SolveStage(plan, parameters, stage, state, work); !solved.ok()) return solved;
  ProjectStage(plan, parameters, stage, work.before, work, state);
  return absl::OkStatus();
}

}  // namespace phrenic
