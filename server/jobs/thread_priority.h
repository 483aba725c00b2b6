// The priority of background threads.
#ifndef PHRENIC_SERVER_JOBS_THREAD_PRIORITY_H_
#define PHRENIC_SERVER_JOBS_THREAD_PRIORITY_H_

#include <sys/resource.h>
#include <unistd.h>

namespace phrenic::jobs {

// Lowers the priority of the calling thread, and of threads that it starts from now on, below that of sessions and
// calls (setpriority(2) with nice 5; on Linux it is the thread's own). Changes nothing where the system forbids it.
inline void LowerThreadPriority() {
  constexpr int kNice = 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

}  // namespace phrenic::jobs

#endif  // PHRENIC_SERVER_JOBS_THREAD_PRIORITY_H_
