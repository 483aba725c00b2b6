// Constraints that can be projected for one block of vertices at a time, while the block's data is in cache.
#ifndef PHRENIC_SERVER_MECHANICS_BLOCK_CONSTRAINT_H_
#define PHRENIC_SERVER_MECHANICS_BLOCK_CONSTRAINT_H_

#include <span>
#include <string>
#include <utility>

#include "server/mechanics/constraint.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// A constraint of which one part involves vertices of one block (kVertexBlock) each, and the rest is projected after
// all blocks. StepPlan projects different blocks on several threads at once. Both parts together give bitwise the
// results of Project.
class BlockConstraint : public Constraint {
 public:
  // True if ProjectBlock has something to project. RecordStart and ProjectBlock require it.
  virtual bool ActsOnBlock(const VertexRange& block, const v1::Parameters& parameters) const = 0;
  // Stores in `start` what ProjectBlock needs of the positions x (3 x n) at the start of the step. `start` has room for
  // 3 kVertexBlock numbers and is aligned for vectors.
  virtual void RecordStart(const VertexRange& block, const ConstPoints& x, double* start) const = 0;
  // Projects the block as Project does; x and v are 3 x n, other blocks are neither read nor written. Returns an upper
  // bound of the displacement of any coordinate [m]; velocities change by the same over `dt`.
  virtual double ProjectBlock(const VertexRange& block, const double* start, double dt, Points& x, Points& v) const = 0;

  // The vertices, ascending, of the rest.
  virtual std::span<const int> vertices_across_blocks() const = 0;
  // Projects the rest. Reads `before` of vertices_across_blocks() only and moves no other vertices.
  virtual void ProjectAcrossBlocks(const v1::Parameters& parameters, const ConstPoints& before, double dt,
                                   const Scratch& scratch, State& state) const = 0;

 protected:
  explicit BlockConstraint(std::string name) : Constraint(std::move(name)) {}
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BLOCK_CONSTRAINT_H_
