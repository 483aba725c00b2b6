// Friction and shared forces of a model as a step evaluates them: in one pass over the vertices.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_

#include <span>
#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/forces/friction.h"
#include "server/mechanics/forces/shared_force.h"
#include "server/mechanics/linalg/vertex_kernel.h"

namespace phrenic {

// The sum of the members' forces: first that of all friction, -c v, then the shared forces in their order. Damping and
// energy are the members' own.
class LoadBatch final : public BlockForce {
 public:
  LoadBatch(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared);

  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  // Returns the loads on one block (kVertexBlock) for the pass that moves its vertices (KickAndDrift). Adds the first
  // ones to `f` if there are more than VertexLoads holds.
  VertexLoads LoadsOnBlock(const VertexRange& block, const EvalContext& at, MutablePoints f) const;

 private:
  Eigen::VectorXd coefficient_;  // c of all friction, one per simulated vertex [N s/m]; empty without friction
  std::vector<const SharedForce*> shared_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_
