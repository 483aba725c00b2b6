// What pulls at each vertex whatever the others do, as a step works it out: friction and shared forces in one pass.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_

#include <span>
#include <vector>

#include "server/mechanics/forces/friction.h"
#include "server/mechanics/forces/shared_force.h"
#include "server/mechanics/linalg/vertex_kernel.h"

namespace phrenic {

// The sum of its members' forces: first that of all friction, -c v, then the shared ones in their order. What else a
// force has to say, its members say.
class LoadBatch final : public Force {
 public:
  LoadBatch(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared);

  bool by_range() const override { return true; }
  void AddForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const override;
  // What is to be added to the forces on a block (kVertexBlock), for a pass over it that has more to do; of more loads
  // than VertexLoads holds the first are added to f.
  VertexLoads InBlock(const VertexRange& block, const EvalContext& at, MutablePoints f) const;

 private:
  Eigen::VectorXd coefficient_;  // c of all friction, one a simulated vertex [N s/m]; none where there is none
  std::vector<const SharedForce*> shared_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_LOAD_BATCH_H_
