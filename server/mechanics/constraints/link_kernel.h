// Links that share no vertex that moves, restored eight at a time (Restore in link.h is the rule): written once with
// Google Highway, the machine's best instruction set chosen at run time, with the same bits on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "server/mechanics/constraints/link.h"

namespace phrenic {

inline constexpr int kPacketLinks = 8;
inline constexpr int kPacketsTogether = 8;
static_assert(kPacketLinks * kPacketsTogether <= 64, "a bit each");

struct alignas(64) LinkPacket {
  double squared_length[kPacketLinks] = {};                           // [m^2]
  double inverse_a[kPacketLinks] = {}, inverse_b[kPacketLinks] = {};  // 1/m of the ends [1/kg]
  std::int32_t a[kPacketLinks] = {}, b[kPacketLinks] = {};            // places of the ends [doubles]
  int count = 0;
  int first = 0;  // of its links
  bool pairs = false;
};

// A vector of each of a packet's links: its direction at the start of a step [m], say.
struct alignas(64) LinkVectors {
  double x[kPacketLinks], y[kPacketLinks], z[kPacketLinks];
};

// Whether the end b is the next vertex to a: they lie together.
constexpr bool IsPair(const Link& link) { return link.b == link.a + 1; }

// The links one after another, numbered from `first` on. Those of a packet begin in one block of vertices
// (kVertexBlock), from which on their places count where all links lie `in_blocks`; and they are all pairs, or none is.
std::vector<LinkPacket> PackLinks(absl::Span<const Link> links, int first, bool in_blocks);

// From a to b of the packets' links; x are points from where their places count.
void FindDirections(absl::Span<const LinkPacket> packets, const double* x, LinkVectors* directions);

struct Restored {
  std::uint64_t missed = 0;  // bit kPacketLinks p + i for link i of packet p
  double way = 0;            // by which a coordinate of an end has moved, at most; no number where one is none [m]
};

// Restores the links of up to kPacketsTogether packets that share no vertex that moves: x and v, points from where
// their places count, change as by Restore over dt [s] along these directions. Those that have turned too far for that
// are missed: they are left as they were. Threads may call at once for packets that share no vertex.
Restored RestorePackets(absl::Span<const LinkPacket> packets, const LinkVectors* directions, double dt, double* x,
                        double* v);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_
