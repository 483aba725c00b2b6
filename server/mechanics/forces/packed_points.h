// Positions in single precision, padded to four numbers per point for aligned loads (spring_kernel.h).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "server/mechanics/scratch.h"
#include "server/mesh/mesh.h"

namespace phrenic {

// An array of numbers, aligned to a cache line. Not thread-safe.
template <typename Number>
class AlignedNumbers {
 public:
  // Returns memory for `count` numbers. Allocates if `count` is the largest so far; the contents are then undefined.
  Number* Fit(Eigen::Index count) {
    const auto lines = static_cast<std::size_t>(count) * sizeof(Number) / 64 + 1;
    if (lines_.size() < lines) lines_.resize(lines);
    return lines_.front().numbers;
  }

 private:
  struct alignas(64) Line {
    Number numbers[64 / sizeof(Number)];
  };
  std::vector<Line> lines_;
};

// Returns the columns of x relative to column `from` [m]. They are valid until the next call with the same scratch
// memory. Runs on the threads of the step.
const float* PackAll(const ConstPoints& x, int from, const Scratch& scratch);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_PACKED_POINTS_H_
