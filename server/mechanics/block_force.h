// Forces that can be evaluated for one block of vertices at a time, while the block's data is in cache.
#ifndef PHRENIC_SERVER_MECHANICS_BLOCK_FORCE_H_
#define PHRENIC_SERVER_MECHANICS_BLOCK_FORCE_H_

#include <string>
#include <utility>

#include "server/mechanics/force.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// A moment of a run with what StepPlan computes once for all blocks.
struct BlockContext : EvalContext {
  const float* packed = nullptr;  // positions in single precision (forces/packed_points.h); null if no force needs them
};

// A force of which the part on a block needs the positions of all vertices and the velocities of the block alone.
// StepPlan evaluates different blocks on several threads at once. The results are bitwise equal to AddForce.
class BlockForce : public Force {
 public:
  // Adds the force on the vertices of `block` [N] to `f`, 3 x the block's vertices. The block is a VertexRange that
  // begins at a multiple of kVertexBlock. Does not use the scratch memory.
  virtual void AddForceToBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const = 0;
  // Sets `f` to that force, whatever it held.
  virtual void SetForceOnBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const {
    f.setZero();
    AddForceToBlock(block, at, f);
  }
  // True if it reads `at.x` of vertices outside the block: a step then keeps the positions at its start.
  virtual bool reads_neighbours() const { return false; }

  void AddForce(const EvalContext& at, MutablePoints f) const override { AddForceToBlock({0, f.cols()}, {at}, f); }

 protected:
  explicit BlockForce(std::string name) : Force(std::move(name)) {}
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BLOCK_FORCE_H_
