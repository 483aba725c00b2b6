// Where the start of a run's last step is found once more: a step may be written over what it starts from.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_

#include "server/mechanics/model.h"

namespace phrenic {

// A copy of the state every so many steps, from which the steps are taken again. Not thread-safe; one for a run.
class StepCheckpoint {
 public:
  // To be told of the state before each step that is taken from it. Allocates the first time.
  void Note(const v1::Parameters& parameters, const State& state);
  // State or parameters are changed otherwise than by a step.
  void Forget() { known_ = false; }
  // The state before the last step, bit for bit; the parameters, and dt [s], are those of the steps.
  State StateBeforeLastStep(const Model& model, const v1::Parameters& parameters, double dt, Workspace& work) const;

 private:
  State kept_;
  bool known_ = false;  // what became of it
  int steps_ = 0;       // since then, with the one to come
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_CHECKPOINT_H_
