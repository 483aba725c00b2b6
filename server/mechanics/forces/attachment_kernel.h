// What carriers pull at the vertices that hold on to them (attachment.h), eight at a time: written once with Google
// Highway, the machine's best instruction set chosen at run time, with the same bits on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_

#include <cstdint>
#include <vector>

#include "server/mechanics/state.h"

namespace phrenic {

inline constexpr int kPacketVertices = 8;

// Up to eight vertices and the share that one pose has in them; what is left of it pulls at nothing.
struct alignas(64) CarriedPacket {
  double x[kPacketVertices] = {}, y[kPacketVertices] = {}, z[kPacketVertices] = {};  // at rest [m]
  double stiffness[kPacketVertices] = {}, damping[kPacketVertices] = {};             // times the share [N/m], [N s/m]
  std::int64_t place[kPacketVertices] = {};  // of the vertex in its block's f [doubles]; none twice
  std::int64_t count = 0;
};

// f += scale (stiffness u + damping u') [N] for each of the packets' vertices, u the way that the pose carries its
// point at rest [m]. f is 3 x n, of a block. Any number of threads may call, at once only for different vertices.
void AddCarried(const Pose& pose, double scale, const CarriedPacket* first, const CarriedPacket* end, double* f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_KERNEL_H_
