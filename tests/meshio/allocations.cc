#include "tests/meshio/allocations.h"

#include <atomic>

namespace {

std::atomic<std::size_t> largest = 0;

[[maybe_unused]] void Record(std::size_t size) {
  if (size > largest) largest = size;
}

}  // namespace

#ifndef PHRENIC_SANITIZED
// Overrides malloc and realloc, which Eigen and operator new call; these are glibc's implementations.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_realloc(void* memory, std::size_t size);

extern "C" void* malloc(std::size_t size) {
  Record(size);
  return __libc_malloc(size);
}

extern "C" void* realloc(void* memory, std::size_t size) {
  Record(size);
  return __libc_realloc(memory, size);
}
#endif

namespace phrenic {

std::size_t TakeLargestAllocation() { return largest.exchange(0); }

}  // namespace phrenic
