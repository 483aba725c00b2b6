// SIMD kernel of the sums over a surface's triangles (chamber.h), eight at a time. Google Highway compiles it for
// several instruction sets and selects the best one at run time. The results are bitwise equal on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

inline constexpr int kPacketTriangles = 8;

// Offsets in x of the corners of eight triangles [doubles]. Padding triangles have three equal corners and add 0.
struct TrianglePacket {
  std::int32_t a[kPacketTriangles], b[kPacketTriangles], c[kPacketTriangles];
};
std::vector<TrianglePacket> PackTriangles(const Triangles& triangles);

struct ChamberReading {
  double volume = 0;  // V [m^3]
  double flow = 0;    // dV/dt [m^3/s]
};

// Returns volume and flow relative to the plane at `height` [m] along the third axis. x (3 x n) are coordinates along
// two axes in the plane and its normal [m], v their rates [m/s]. Without v the flow is 0. Thread-safe.
ChamberReading SumTriangles(const std::vector<TrianglePacket>& packets, double height, const double* x,
                            const double* v = nullptr);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_
