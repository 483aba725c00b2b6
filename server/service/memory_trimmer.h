// Gives freed memory back to the system.
#ifndef PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
#define PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_

#include <cstddef>

namespace phrenic::service {

// Sets how much freed memory each of malloc's heaps keeps: 8 MiB, where glibc keeps up to 64 MiB after it has freed a
// large block, which malloc_trim does not give back. Affects the whole process. Call it before threads start.
void LimitFreeMemory();

// glibc keeps what was freed after a peak, such as thousands of calls at once. Not thread-safe. The server has one,
// which its maintenance thread calls every 2 s.
class MemoryTrimmer {
 public:
  // Gives freed memory back if there is 8 MiB more of it in memory than after the last time. What malloc's lists hold
  // does not tell: memory that was given back stays in them. Trims the heaps of all threads of the process
  // (malloc_trim).
  void Trim();

 private:
  std::size_t least_ = 0;  // in memory without being allocated, since the last time [bytes]
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
