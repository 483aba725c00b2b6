// Sums over a surface's triangles for the volume that it bounds (chamber.h), eight at a time: written once with Google
// Highway, the machine's best instruction set chosen at run time, with the same bits on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

inline constexpr int kPacketTriangles = 8;

// Where the corners of eight triangles are in x [doubles]; one that is lacking has the same vertex three times, which
// adds nothing.
struct TrianglePacket {
  std::int32_t a[kPacketTriangles], b[kPacketTriangles], c[kPacketTriangles];
};
std::vector<TrianglePacket> PackTriangles(const Triangles& triangles);

struct ChamberReading {
  double volume = 0;  // V [m^3]
  double flow = 0;    // dV/dt [m^3/s]
};

// Over the plane at `height` [m] across the third axis: x are 3 x n coordinates along the plane's two axes and its
// normal [m], v their rates [m/s]. Without v the flow is 0. Any number of threads may call.
ChamberReading SumTriangles(const std::vector<TrianglePacket>& packets, double height, const double* x,
                            const double* v = nullptr);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_CHAMBER_KERNEL_H_
