// How much memory this program has asked for at once: what a file merely claims must not make it ask for.
#ifndef PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_
#define PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_

#include <cstddef>

namespace phrenic {

// The largest size that malloc or realloc was asked for since the last call; always 0 under sanitizers, which have a
// malloc of their own. [bytes]
std::size_t TakeLargestAllocation();

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_
