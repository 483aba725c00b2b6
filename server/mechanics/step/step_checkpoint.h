// Recomputes the state before the last step of a run: a step may be written over its start.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_

#include "server/mechanics/model.h"

namespace phrenic {

// A copy of the state every few steps, from which the steps are repeated. One per run. Not thread-safe.
class StepCheckpoint {
 public:
  // Is told the state before each step. Allocates the first time.
  void Note(const Model& model, const v1::Parameters& parameters, const State& state);
  // State or parameters change otherwise than by a step.
  void Forget() { known_ = false; }
  // Returns the state before the last step, bit for bit. Requires: `parameters` and dt [s] are those of the steps.
  State StateBeforeLastStep(const Model& model, const v1::Parameters& parameters, double dt, Workspace& work) const;

 private:
  State kept_;
  bool known_ = false;  // `kept_` and `steps_` belong to the run
  int steps_ = 0;       // from `kept_` on, with the one that follows
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_
