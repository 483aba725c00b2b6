// What integrators are made of.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_ADVANCE_H_
#define PHRENIC_SERVER_MECHANICS_STEP_ADVANCE_H_

#include <span>
#include <vector>

#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/model.h"

namespace phrenic {

// The moment `ahead` [s] of the state's own time, seen with its present positions, velocities and poses.
EvalContext EvalContextAhead(const Model& model, const v1::Parameters& parameters, double ahead, const State& state);

// Sets driven vertices and poses to where the motions have them `ahead` [s] of the state's own time.
void DriveMotions(const Model& model, const v1::Parameters& parameters, double ahead, State& state);

// f = the sum of all forces and pulls [N].
void SumForces(const Model& model, const EvalContext& at, Points& f);
// The same in three parts: positions packed, and poses as columns, where forces ask for it, in memory of the thread's
// own until its next call; then what can only be worked out for all vertices at once, false and f as it was where there
// is nothing of the kind; and the rest range by range, added to f, 3 x the range's vertices, or where it is `fresh` set
// as f.
EvalContext Packed(const Model& model, const EvalContext& at);
bool SumWholeForces(const Model& model, const EvalContext& at, Points& f);
void AddForcesIn(const VertexRange& range, const Model& model, const EvalContext& at, bool fresh, MutablePoints f);
// The same of a block, but for what its kick is to add.
VertexLoads AddForcesButLoads(const VertexRange& block, const Model& model, const EvalContext& at, bool fresh,
                              MutablePoints f);

// c = the sum of all damping coefficients [N s/m].
void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c);
void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared);

// A place for each block of that many vertices, and one more; how far a block has got, noted at its place, and how far
// some vertices have, wherever they lie, at the one more.
void ResizeBounds(Eigen::Index vertices, std::vector<StateBounds>& blocks);
void RecordBounds(const VertexRange& block, const StateBounds& reach, std::vector<StateBounds>& blocks);
void RecordBounds(std::span<const int> vertices, const Points& x, const Points& v, std::vector<StateBounds>& blocks);

// x += shift, but for fixed and driven vertices; shift 3 x n.
void AddToFree(const Model& model, double scale, const Points& shift, Points& x);

// Constraints in the scene's order: positions (and velocities with them), or velocities alone. Where there are several,
// again and again until all hold or no more is gained, 50 times at most. A thread's first call may allocate.
void ProjectPositions(const Model& model, const v1::Parameters& parameters, const ConstPoints& before, double dt,
                      State& state);
void ProjectVelocities(const Model& model, const v1::Parameters& parameters, State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_ADVANCE_H_
