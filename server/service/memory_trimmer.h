// Gives freed memory back to the system.
#ifndef PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
#define PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_

#include <cstddef>

namespace phrenic::service {

// glibc keeps what was freed after a peak, such as thousands of calls at once. Not thread-safe. The server has one,
// which its maintenance thread calls every 2 s.
class MemoryTrimmer {
 public:
  // Gives freed memory back, unless less than 8 MiB was freed since the last time. Trims the heaps of all threads of
  // the process (malloc_trim).
  void Trim();

 private:
  std::size_t free_ = 0;  // in malloc's lists after the last time, given back or not [bytes]
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
