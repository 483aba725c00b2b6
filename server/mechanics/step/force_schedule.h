// The order in which a step evaluates a model's forces, and which of them it evaluates together.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_FORCE_SCHEDULE_H_
#define PHRENIC_SERVER_MECHANICS_STEP_FORCE_SCHEDULE_H_

#include <memory>
#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/model.h"
#include "server/mechanics/step/load_batch.h"

namespace phrenic {

// Immutable once made. Forces are the model's own or those of `batches`.
struct ForceSchedule {
  std::vector<std::unique_ptr<const Force>> batches;  // each replaces several forces of the model
  std::vector<const Force*> whole;                    // evaluated first, each for all vertices at once
  std::vector<const BlockForce*> by_block;            // evaluated block by block, in this order
  const LoadBatch* loads = nullptr;  // evaluated last; semi-implicit Euler adds it while it moves a block's vertices
  int packing_origin = -1;  // vertex from which positions in single precision are measured; -1 if no force needs them
};

// Springs come first, one batch for each precision; friction and shared forces (gravity, action lines) come last, as
// one batch. The others keep the scene's order. Leaves out forces that act on no vertex.
ForceSchedule ScheduleForces(const Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_FORCE_SCHEDULE_H_
