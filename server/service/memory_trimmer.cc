#include "server/service/memory_trimmer.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace phrenic::service {
namespace {

constexpr int kLargeBlock = 4 << 20;                    // larger ones are mapped and given back one by one [bytes]
constexpr int kKept = 8 << 20;                          // at the end of a heap [bytes]
constexpr std::size_t kWorthIt = std::size_t{8} << 20;  // [bytes]

// Returns how much of the process is in memory without being allocated: code, stacks, and what was freed [bytes].
std::size_t UnallocatedMemory() {
  std::size_t size = 0, resident = 0;  // [pages]
  std::ifstream("/proc/self/statm") >> size >> resident;
  const struct mallinfo2 heap = mallinfo2();
  const std::size_t bytes = resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return bytes - std::min(bytes, heap.uordblks + heap.hblkhd);
}

}  // namespace

void LimitFreeMemory() {
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  mallopt(M_TRIM_THRESHOLD, kKept);
}

void MemoryTrimmer::Trim() {
  const std::size_t unallocated = UnallocatedMemory();
  least_ = std::min(least_, unallocated);
  if (unallocated < least_ + kWorthIt) return;
  malloc_trim(0);
  least_ = UnallocatedMemory();
}

}  // namespace phrenic::service
