#include "server/mechanics/step/step_checkpoint.h"

#include "server/mechanics/compile/catalogue.h"
#include "server/mechanics/step/step.h"

namespace phrenic {
namespace {

// Steps from one copy to the next. It costs a quick one next to nothing, and few are dear to take again. What a solver
// finds in a limited time it may not find again.
int StepsOf(const v1::Parameters& parameters) {
  if (parameters.solver_budget() > 0) return 1;
  return FindIntegrator(parameters.integrator()).needs_start() ? 8 : 64;
}

}  // namespace

void StepCheckpoint::Note(const v1::Parameters& parameters, const State& state) {
  if (!known_ || steps_ >= StepsOf(parameters)) {
    kept_ = state;
    known_ = true;
    steps_ = 0;
  }
  ++steps_;
}

State StepCheckpoint::StateBeforeLastStep(const Model& model, const v1::Parameters& parameters, double dt,
                                          Workspace& work) const {
  State state = kept_;
  for (int step = 1; step < steps_; ++step) Step(model, parameters, dt, state, work).IgnoreError();  // it was good
  return state;
}

}  // namespace phrenic
