// Which simulated vertices a piece of a step's work is for.
#ifndef PHRENIC_SERVER_MECHANICS_PARALLEL_VERTEX_RANGE_H_
#define PHRENIC_SERVER_MECHANICS_PARALLEL_VERTEX_RANGE_H_

#include <Eigen/Core>
#include <algorithm>

#include "server/mechanics/parallel/parallel_for.h"

namespace phrenic {

// Vertices first to end - 1.
struct VertexRange {
  Eigen::Index first = 0, end = 0;
};

// Ranges begin, and but for the last one end, at a multiple of this. A block's forces, positions and velocities, before
// and after a step, fit into a core's nearest cache beside what its springs take.
inline constexpr Eigen::Index kVertexBlock = 256;

// Calls `work` with the blocks of a range, shared out over the threads of a step.
template <typename Work>
void ForEachBlock(const VertexRange& range, const Work& work) {
  const Eigen::Index blocks = (range.end - range.first + kVertexBlock - 1) / kVertexBlock;
  ParallelFor(blocks, [&](std::int64_t block) {
    const Eigen::Index first = range.first + block * kVertexBlock;
    work(VertexRange{first, std::min(first + kVertexBlock, range.end)});
  });
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PARALLEL_VERTEX_RANGE_H_
