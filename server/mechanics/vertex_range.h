// Which simulated vertices a piece of a step's work is for.
#ifndef PHRENIC_SERVER_MECHANICS_VERTEX_RANGE_H_
#define PHRENIC_SERVER_MECHANICS_VERTEX_RANGE_H_

#include <Eigen/Core>
#include <algorithm>

namespace phrenic {

// Vertices first to end - 1.
struct VertexRange {
  Eigen::Index first = 0, end = 0;
};

// Ranges begin, and but for the last one end, at a multiple of this. A block's forces, positions and velocities fit
// into a core's nearest cache.
inline constexpr Eigen::Index kVertexBlock = 512;

// Calls `work` with the blocks of a range, one after the other.
template <typename Work>
void ForEachBlock(const VertexRange& range, const Work& work) {
  for (Eigen::Index first = range.first; first < range.end; first += kVertexBlock) {
    work(VertexRange{first, std::min(first + kVertexBlock, range.end)});
  }
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_VERTEX_RANGE_H_
