#include "server/service/memory_trimmer.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace phrenic::service {
namespace {

constexpr std::int64_t kGrowth = std::int64_t{8} << 20;  // of resident memory [bytes]

// Returns 0 if it is not known.
std::int64_t ResidentBytes() {
  std::int64_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace

void MemoryTrimmer::Trim() {
  if (const std::int64_t now = ResidentBytes(); now < trimmed_ + kGrowth) {
    trimmed_ = std::min(trimmed_, now);
    return;
  }
  malloc_trim(0);
  trimmed_ = ResidentBytes();
}

}  // namespace phrenic::service
