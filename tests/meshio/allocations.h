// Records the largest allocation of the process, to show that a count which a file merely claims is never allocated.
#ifndef PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_
#define PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_

#include <cstddef>

namespace phrenic {

// Returns the largest size passed to malloc or realloc since the last call [bytes]. Always 0 under sanitizers, which
// replace malloc.
std::size_t TakeLargestAllocation();

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MESHIO_ALLOCATIONS_H_
