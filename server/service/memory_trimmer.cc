#include "server/service/memory_trimmer.h"

#include <malloc.h>

#include <algorithm>

namespace phrenic::service {
namespace {

constexpr std::size_t kFreed = std::size_t{8} << 20;  // since the last time, that is worth it [bytes]

}  // namespace

void MemoryTrimmer::Trim() {
  const std::size_t free = mallinfo2().fordblks;
  if (free >= free_ + kFreed) malloc_trim(0);
  free_ = free >= free_ + kFreed ? free : std::min(free_, free);
}

}  // namespace phrenic::service
