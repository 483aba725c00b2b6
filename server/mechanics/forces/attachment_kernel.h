// What pulls at the vertices that hold on to carriers (attachment.h), eight at a time: written once with Google
// Highway, the machine's best instruction set chosen at run time, with the same bits on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mechanics/skinning/pose_matrices.h"

namespace phrenic {

inline constexpr int kPacketVertices = 8;

// Up to eight vertices of a block; what is left of it pulls at nothing.
struct alignas(64) HoldPacket {
  double x[kPacketVertices] = {}, y[kPacketVertices] = {}, z[kPacketVertices] = {};  // at rest [m]
  double stiffness[kPacketVertices] = {}, damping[kPacketVertices] = {};             // [N/m], [N s/m]
  std::int32_t place[kPacketVertices] = {};  // of the vertex in its block's arrays [doubles]; none twice
  std::int32_t count = 0;
};

// Both are for packets first to end - 1 of one block, whose positions, velocities and forces are 3 x n. Any number of
// threads may call, at once only for different vertices.

// f += stiffness (r - x) - damping v [N] for each vertex, r where it is at rest.
void AddHeld(const HoldPacket* first, const HoldPacket* end, const double* x, const double* v, double* f);

// f += scale (stiffness u + damping u') [N] for each vertex, u the way that the pose carries its point at rest [m];
// stiffness and damping are times the pose's share in it.
void AddCarried(const PoseMatrices& pose, double scale, const HoldPacket* first, const HoldPacket* end, double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
