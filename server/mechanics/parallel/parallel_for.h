// The threads that the steps of all sessions share. A step is divided into blocks of vertices, each computed by one
// thread, so that any number of threads gives the same bits.
#ifndef PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_
#define PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_

#include <cstdint>

#include "absl/functional/function_ref.h"

namespace phrenic {

// Sets the number of threads of a step, including its caller; initially 1, the caller alone. The others belong to the
// process and serve the first step that asks. Requires: no step is running.
void SetStepThreads(int threads);
int StepThreads();

// Calls work(part) once for each part from 0 to parts - 1, in any order, on the caller and the threads that are idle;
// on the caller alone if there are few parts. Each thread begins with the same parts in every call with as many: what
// it wrote there last is still in its core's cache. Returns when all are done; never waits for a thread that has not
// begun. Thread-safe.
void ParallelFor(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_
