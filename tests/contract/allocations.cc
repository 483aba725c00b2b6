#include "tests/contract/allocations.h"

#include <atomic>
#include <cstddef>

namespace {

std::atomic<std::int64_t> calls = 0;

}  // namespace

#ifndef PHRENIC_SANITIZED
// glibc's own names; Eigen and operator new come by here.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_realloc(void* memory, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

extern "C" void* malloc(std::size_t size) {
  ++calls;
  return __libc_malloc(size);
}

extern "C" void* realloc(void* memory, std::size_t size) {
  ++calls;
  return __libc_realloc(memory, size);
}

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++calls;
  return __libc_memalign(alignment, size);
}
#endif

namespace phrenic {

std::int64_t Allocations() { return calls; }

}  // namespace phrenic
