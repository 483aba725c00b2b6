// The priority of background threads.
#ifndef PHRENIC_SERVER_SCHEMA_THREAD_PRIORITY_H_
#define PHRENIC_SERVER_SCHEMA_THREAD_PRIORITY_H_

#include <unistd.h>

namespace phrenic {

// Lowers the priority of the calling thread, and of threads that it starts from now on, below that of sessions and
// calls (nice(2) by 5, which is the thread's own on Linux). Changes nothing where the system forbids it.
inline void LowerThreadPriority() {
  constexpr int kLower = 5;
  [[maybe_unused]] const int priority = nice(kLower);
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_THREAD_PRIORITY_H_
