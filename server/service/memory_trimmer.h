// Gives freed memory back to the system.
#ifndef PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
#define PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_

#include <cstdint>

namespace phrenic::service {

// glibc keeps what was freed after a peak, such as thousands of calls at once. Not thread-safe.
class MemoryTrimmer {
 public:
  // Gives freed memory back, unless the process has hardly grown since the last time.
  void Trim();

 private:
  std::int64_t trimmed_ = 0;  // resident memory after the last time [bytes]
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_MEMORY_TRIMMER_H_
