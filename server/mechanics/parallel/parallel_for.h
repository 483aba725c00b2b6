// The threads that steps of all sessions share. A step is cut into ranges of vertices, each worked out whole by one
// thread, so that any number of threads gives the same bits.
#ifndef PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_
#define PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_

#include <cstdint>

#include "absl/functional/function_ref.h"

namespace phrenic {

// How many threads a step may have, its caller among them; 1, as at the start, is the caller alone. The others are kept
// by the process and help whichever step asked first. Not while a step runs.
void SetStepThreads(int threads);
int StepThreads();

// Calls work(part) once for each part from 0 to parts - 1, on the caller and on whichever of the others are free, in
// any order; few parts on the caller alone. Each thread begins with parts of its own, the same in every call of as
// many: what it wrote there last is still in its core's cache. Returns when all are done, and never waits for a thread
// that has not begun. Any number of threads may call.
void ParallelFor(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PARALLEL_PARALLEL_FOR_H_
