// Which forces a step sums, and which of them it works out together.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_FORCES_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_FORCES_H_

#include "server/mechanics/model.h"

namespace phrenic {

// Sets the model's `whole_forces` and `range_forces`: springs first and loads last, each worked out together in
// `batches`, the others in their order between them.
void ChooseStepForces(Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_FORCES_H_
