// The threads of a compile: loops whose parts do not depend on each other run on all cores.
#ifndef PHRENIC_SERVER_MECHANICS_PARALLEL_COMPILE_THREADS_H_
#define PHRENIC_SERVER_MECHANICS_PARALLEL_COMPILE_THREADS_H_

#include <algorithm>
#include <cstdint>

#include "absl/functional/function_ref.h"

namespace phrenic {

// Sets the most threads that a compile uses, the caller's among them: 1 to 16. Initially one per core, at most 16.
// Thread-safe.
void SetCompileThreads(int threads);
int CompileThreads();
// Sets a function that each thread except the caller's calls first: a server lowers the thread's priority, so that a
// compile does not slow sessions that play. Initially nothing. Thread-safe.
void SetCompileThreadStart(void (*start)());

// Calls work(part) once for each part from 0 to parts - 1, in any order, on the caller and on threads that end before
// it returns. The result is the same, bit for bit, for any number of threads if the parts write to separate memory.
// Thread-safe.
void ForEachPart(std::int64_t parts, absl::FunctionRef<void(std::int64_t)> work);
// The same, but leaves out the parts that have not begun once stopped() is true, which the caller's thread alone asks,
// before each of its parts.
void ForEachPartUntil(std::int64_t parts, absl::FunctionRef<bool()> stopped,
                      absl::FunctionRef<void(std::int64_t)> work);

// A range of vertices, or of other items that take some microseconds each.
struct PartRange {
  std::int64_t first, end;
};
inline constexpr std::int64_t kPartItems = 256;  // of a part: longer than starting a thread takes
inline std::int64_t CountParts(std::int64_t items) { return (items + kPartItems - 1) / kPartItems; }
inline PartRange PartOf(std::int64_t items, std::int64_t part) {
  return {part * kPartItems, std::min(items, (part + 1) * kPartItems)};
}

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_PARALLEL_COMPILE_THREADS_H_
