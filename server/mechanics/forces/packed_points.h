// Positions in single precision, four numbers each (spring_kernel.h), in memory of the calling thread's own.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// What positions are kept for: packed for all that ask, or put into one batch of springs' own order.
enum class Kept { kForAll, kInOrder };

// `count` Numbers, aligned to a cache line: the thread's own, for all that help it, until it asks again for the same.
// Allocates where it has never asked for as many.
template <Kept kWhat, typename Number>
Number* ThreadMemory(Eigen::Index count) {
  struct alignas(64) Line {
    Number numbers[64 / sizeof(Number)];
  };
  thread_local std::vector<Line> memory;
  const auto lines = static_cast<std::size_t>(count) * sizeof(Number) / 64 + 1;
  if (memory.size() < lines) memory.resize(lines);
  return memory.front().numbers;
}

// The columns of x, from where column `from` is [m]; shared out over the threads of a step.
const float* PackAll(const ConstPoints& x, int from);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_
