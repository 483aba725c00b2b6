// The check for divergence: after each step every vertex lies within Model::bound; or, of a part that nothing holds and
// that may fall or fly, within as much of the part's centre. Integrators that move vertices block
// by block record each block's bounds while its data is in cache; for the others the check reads all vertices.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_BOUNDS_H_
#define PHRENIC_SERVER_MECHANICS_STEP_BOUNDS_H_

#include <span>

#include "server/mechanics/model.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// Makes room in work.bounds for one entry per block and one more, which is 0, for vertices of any block.
void ResizeBounds(Workspace& work);

// Sets the entry of a block. Threads may call at once for different blocks. Requires: ResizeBounds.
void RecordBounds(const VertexRange& block, const StateBounds& bounds, Workspace& work);

// Extends the last entry by some vertices. Requires: ResizeBounds.
void RecordBounds(std::span<const int> vertices, const State& state, Workspace& work);

// Returns true if every coordinate is a number of at most model.bound; of a loose part (LooseParts), if the coordinates
// relative to its centre are, and the centre's own are at most kFurthestFall times as large.
inline constexpr double kFurthestFall = 1000;
bool PositionsWithinBounds(const Model& model, const ConstPoints& x);

// Returns true if PositionsWithinBounds, and no velocity crosses twice that within `dt`:
// constraints may hold positions while velocities grow. Uses the recorded bounds if there are any.
bool WithinBounds(const Model& model, double dt, const State& state, Workspace& work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_BOUNDS_H_
