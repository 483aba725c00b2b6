// CPU time of one thread.
#ifndef PHRENIC_SERVER_SCHEMA_THREAD_CPU_H_
#define PHRENIC_SERVER_SCHEMA_THREAD_CPU_H_

namespace phrenic {

// Returns the CPU time that the calling thread has used since it started [s].
double ThreadCpuSeconds();

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_THREAD_CPU_H_
