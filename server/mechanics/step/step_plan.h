// How a step evaluates a model: decided once, when the scene is compiled. Integrators are composed of its operations.
//
// Forces and constraints that can be evaluated per block of vertices (BlockForce, BlockConstraint) are, so that what a
// step does with one block stays in a core's L1 cache; the others are evaluated for all vertices, forces before and
// constraints after the blocks. Blocks run on the threads of a step (ParallelFor); any number of threads gives the same
// bits.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_STEP_PLAN_H_
#define PHRENIC_SERVER_MECHANICS_STEP_STEP_PLAN_H_

#include <memory>
#include <span>

#include "server/mechanics/block_constraint.h"
#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/model.h"
#include "server/mechanics/step/force_schedule.h"

namespace phrenic {

// Arrays of one block that a thread keeps on its stack. Not initialised.
struct BlockMemory {
  alignas(64) double force[3 * kVertexBlock];  // 3 x the block's vertices [N]
  alignas(64) double start[3 * kVertexBlock];  // of BlockConstraint::RecordStart
};

// The forces on one block: their sum, 3 x the block's vertices [N], and the loads to be added to it.
struct BlockForces {
  MutablePoints sum;
  VertexLoads loads;
};

// The arrays to which a step writes its end, 3 x n: the state's own, or the workspace's, which then change places.
struct StepEnd {
  Points &x, &v;  // [m], [m/s]
};

// Immutable; any number of threads may call, each with a state and workspace of its own. Refers to the model, which
// owns it and outlives it.
class StepPlan {
 public:
  StepPlan(const Model& model, ForceSchedule schedule, const IntegratorTable& integrators);
  StepPlan(const StepPlan&) = delete;
  StepPlan& operator=(const StepPlan&) = delete;

  const Model& model() const { return model_; }
  const ForceSchedule& schedule() const { return schedule_; }
  const IntegratorTable& integrators() const { return integrators_; }
  // Returns the integrator that the parameters name.
  const Integrator& FindIntegrator(const v1::Parameters& parameters) const;

  // Returns the moment `ahead` [s] of the state's time, with its present positions, velocities and poses.
  EvalContext ContextAhead(const v1::Parameters& parameters, double ahead, const State& state,
                           const Scratch& scratch) const;
  // True if motions follow coordinates, which forces move: DriveMotions must be called again at the end of a step.
  bool follows_coordinates() const { return follows_coordinates_; }
  // Sets driven vertices and poses to where the motions have them `ahead` [s] of the state's time.
  void DriveMotions(const v1::Parameters& parameters, double ahead, const Scratch& scratch, State& state) const;
  // Advances the scalars that forces advance (Force::AdvanceScalars) to the end of a step of `dt` [s], at which the
  // positions, velocities and poses of `state` are already, but not its time.
  void AdvanceScalars(const v1::Parameters& parameters, double dt, const Scratch& scratch, State& state) const;
  // Sets the rates of the scalars that forces integrate (Force::SetScalarRates) at the moment of the state.
  void SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const;
  // Sets f to the sum of all forces and pulls, with those that motions transfer to coordinates, 3 x n [N].
  void SumForces(const EvalContext& at, Points& f) const;
  // Adds scale * shift (3 x n) to x, except for fixed and driven vertices.
  void AddToFree(double scale, const Points& shift, Points& x) const;
  // Projects positions, and velocities with them, onto all constraints in the scene's order. Several constraints are
  // repeated until all hold or the residual stops falling, at most 50 times. `before` and `dt` as in
  // Constraint::Project.
  void ProjectPositions(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
                        State& state) const;
  // Projects velocities onto all constraints in the same way.
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const;

  // The operations of a step block by block, in their order.
  //
  // Stores what later operations need of the start of the step and DriveMotions overwrites.
  void KeepStart(const State& state, Workspace& work) const;
  // Returns the moment of the state with what blocks need of all vertices. Sets work.force to the sum of the forces
  // that are evaluated for all vertices, and work.shared_damping.
  BlockContext PrepareBlocks(const v1::Parameters& parameters, const State& state, Workspace& work) const;
  // Returns the arrays to which the step writes its end.
  StepEnd ChooseEnd(State& state, Workspace& work) const;
  // Calls work(VertexRange) for each block, on the threads of a step.
  template <typename Work>
  void ForEachBlock(const Work& work) const {
    phrenic::ForEachBlock({0, model_.rest.cols()}, work);
  }
  // Returns the sum of all forces and pulls on a block, without the loads that are to be added to it.
  BlockForces SumForces(const VertexRange& block, const BlockContext& at, Workspace& work, BlockMemory& memory) const;
  // Stores in `memory` what ProjectWithinBlock needs of the start of the step.
  void RecordStart(const VertexRange& block, const BlockContext& at, BlockMemory& memory) const {
    if (ActsOnBlock(block, at.parameters)) block_constraint_->RecordStart(block, at.x, memory.start);
  }
  // Projects the part of the constraint that involves this block alone. Returns the block's bounds, given those before.
  StateBounds ProjectWithinBlock(const VertexRange& block, const BlockContext& at, const BlockMemory& memory, double dt,
                                 const StepEnd& end, const StateBounds& bounds) const {
    if (!ActsOnBlock(block, at.parameters)) return bounds;
    const double displacement = block_constraint_->ProjectBlock(block, memory.start, dt, end.x, end.v);
    return {bounds.furthest + displacement, bounds.fastest + displacement / dt};
  }
  // Stores the bounds of a block in work.bounds, unless operations after the blocks move its vertices.
  void RecordBounds(const VertexRange& block, const StateBounds& bounds, Workspace& work) const {
    if (final_in_blocks_) work.bounds[block.first / kVertexBlock] = bounds;
  }
  // Corrects the end of a step x' = x + dt v', M (v' - v) = dt f for the damping S that vertices share:
  // (M + dt S)(v' - v) = dt f.
  void ApplySharedDamping(double dt, const State& start, const StepEnd& end, Workspace& work) const;
  // Makes `end` the state, and work.before the positions at the start of the step, as far as constraints read them.
  void TakeEnd(const StepEnd& end, State& state, Workspace& work) const;
  // Projects what blocks have not: the rest of a BlockConstraint, or all constraints.
  void ProjectAcrossBlocks(const v1::Parameters& parameters, double dt, State& state, Workspace& work) const;

 private:
  BlockContext WithSharedResults(const EvalContext& at) const;
  bool SumWholeForces(const EvalContext& at, Points& f) const;
  void AddBlockForces(const VertexRange& block, const BlockContext& at, bool first, bool with_loads,
                      MutablePoints f) const;
  bool ActsOnBlock(const VertexRange& block, const v1::Parameters& parameters) const {
    return block_constraint_ != nullptr && block_constraint_->ActsOnBlock(block, parameters);
  }

  const Model& model_;
  const ForceSchedule schedule_;
  const IntegratorTable integrators_;
  const bool follows_coordinates_;                 // a motion does: blocks need the forces on all vertices first
  const bool shares_damping_;                      // a force has shared damping
  const bool advances_scalars_;                    // a force advances scalars
  const BlockConstraint* const block_constraint_;  // the only constraint, if it can be projected per block; or null
  const bool final_in_blocks_;                     // nothing after the blocks moves vertices but ProjectAcrossBlocks
  const bool may_overwrite_start_;                 // no operation reads the start of a vertex after its block
};

// Makes the plan of a compiled model. The model keeps its address.
std::shared_ptr<const StepPlan> MakeStepPlan(const Model& model, const IntegratorTable& integrators);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_STEP_PLAN_H_
