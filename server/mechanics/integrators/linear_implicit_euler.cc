#include "server/mechanics/integrators/linear_implicit_euler.h"

#include <limits>

#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {

double LinearImplicitEuler::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status LinearImplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                          Workspace& work) const {
  state.v.setZero();  // so that forces and stiffness are those where the step begins
  const ImplicitStage stage{.ahead = dt,
                            .g = dt,
                            .position = work.before,
                            .velocity = work.velocity_before,
                            .newton_steps = 1,
                            .guess = &work.velocity_before};
  if (absl::Status solved = SolveStage(model, parameters, stage, state, work); !solved.ok()) return solved;
  ProjectPositions(model, parameters, work.before, dt, state);
  ProjectVelocities(model, parameters, state);
  return absl::OkStatus();
}

}  // namespace phrenic
