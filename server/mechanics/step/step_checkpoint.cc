#include "server/mechanics/step/step_checkpoint.h"

#include "server/mechanics/step/step.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

// Steps per copy. A copy costs little beside an implicit step, and few of those are expensive to repeat. A step that a
// solver's time limit cuts short cannot be repeated: its start is copied.
int StepsPerCopy(const StepPlan& plan, const v1::Parameters& parameters) {
  if (parameters.solver_budget() > 0) return 1;
  return plan.FindIntegrator(parameters).needs_start() ? 8 : 64;
}

}  // namespace

void StepCheckpoint::Note(const Model& model, const v1::Parameters& parameters, const State& state) {
  if (!known_ || steps_ >= StepsPerCopy(*model.plan, parameters)) {
    kept_ = state;
    known_ = true;
    steps_ = 0;
  }
  ++steps_;
}

State StepCheckpoint::StateBeforeLastStep(const Model& model, const v1::Parameters& parameters, double dt,
                                          Workspace& work) const {
  State state = kept_;
  for (int step = 1; step < steps_; ++step) Step(model, parameters, dt, state, work).IgnoreError();  // each succeeded
  return state;
}

}  // namespace phrenic
