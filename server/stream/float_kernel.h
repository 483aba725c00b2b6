// SIMD kernel that converts numbers for frames. Google Highway compiles it for several instruction sets and selects the
// best one at run time. The results are bitwise equal on all of them. Thread-safe.
#ifndef PHRENIC_SERVER_STREAM_FLOAT_KERNEL_H_
#define PHRENIC_SERVER_STREAM_FLOAT_KERNEL_H_

#include <cstddef>

namespace phrenic::stream {

// Sets `to` to the nearest floats. Returns true if all of them are finite.
bool ToFloats(const double* from, std::size_t count, float* to);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_FLOAT_KERNEL_H_
