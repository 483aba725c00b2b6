// SIMD kernels of attachments (attachment.h), eight vertices at a time. Google Highway compiles them for several
// instruction sets and selects the best one at run time. The results are bitwise equal on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mechanics/skinning/pose_matrices.h"

namespace phrenic {

inline constexpr int kPacketVertices = 8;

// Up to eight attached vertices of one block. Unused lanes are padding and exert no force.
struct alignas(64) HoldPacket {
  double x[kPacketVertices] = {}, y[kPacketVertices] = {}, z[kPacketVertices] = {};  // rest positions [m]
  double stiffness[kPacketVertices] = {}, damping[kPacketVertices] = {};             // [N/m], [N s/m]
  std::int32_t offset[kPacketVertices] = {};  // offset of the vertex in its block's arrays [doubles]; no duplicates
  std::int32_t count = 0;
};

// Both functions process the packets [first, end) of one block; x [m], v [m/s] and f [N] are the block's 3 x n arrays.
// Thread-safe for disjoint vertices.

// Adds stiffness (r - x) - damping v [N] to f for each vertex, r its rest position.
void AddHeld(const HoldPacket* first, const HoldPacket* end, const double* x, const double* v, double* f);

// Adds scale (stiffness u + damping u') [N] to f for each vertex, u the displacement that the pose gives its rest
// position [m]. Stiffness and damping are already multiplied by the pose's skin weight.
void AddCarried(const PoseMatrices& pose, double scale, const HoldPacket* first, const HoldPacket* end, double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
