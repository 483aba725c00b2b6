// Ranges and blocks of simulated vertices, and loops over blocks on several threads.
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

// Vertices per block. Ranges begin at a multiple of this and, except for the last, end at one. Forces, positions and
// velocities of a block, before and after a step, fit into a core's L1 cache beside the data of its springs.
inline constexpr Eigen::Index kVertexBlock = 256;

// Returns the number of blocks of so many vertices; the last may be incomplete.
inline Eigen::Index CountBlocks(Eigen::Index vertices) { return (vertices + kVertexBlock - 1) / kVertexBlock; }

// Calls work(VertexRange) once for each block of a range, on the threads of a step (ParallelFor), in any order.
template <typename Work>
void ForEachBlock(const VertexRange& range, const Work& work) {
  ParallelFor(CountBlocks(range.end - range.first), [&](std::int64_t block) {
    const Eigen::Index first = range.first + block * kVertexBlock;
    work(VertexRange{first, std::min(first + kVertexBlock, range.end)});
  });
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PARALLEL_VERTEX_RANGE_H_
