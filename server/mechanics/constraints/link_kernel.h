// SIMD kernel that restores links without common movable vertices, eight at a time, as Restore in link.h does. Google
// Highway compiles it for several instruction sets and selects the best one at run time. The results are bitwise equal
// on all of them.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "server/mechanics/constraints/link.h"

namespace phrenic {

inline constexpr int kPacketLinks = 8;
inline constexpr int kPacketsTogether = 8;
static_assert(kPacketLinks * kPacketsTogether <= 64, "one bit per link in Restored::missed");

struct alignas(64) LinkPacket {
  double squared_length[kPacketLinks] = {};                           // [m^2]
  double inverse_a[kPacketLinks] = {}, inverse_b[kPacketLinks] = {};  // 1/m of the ends [1/kg]
  std::int32_t a[kPacketLinks] = {}, b[kPacketLinks] = {};            // offsets of the ends in x and v [doubles]
  int count = 0;                                                      // used lanes; the others are padding
  int first = 0;                                                      // index of its first link
  bool pairs = false;                                                 // all links are pairs (IsPair)
  int sign = 0;                                                       // of all its links (Link::sign)
  double relaxation = 1;                                              // factor of its corrections
};

// One vector per link of a packet, such as its direction at the start of the step [m].
struct alignas(64) LinkVectors {
  double x[kPacketLinks], y[kPacketLinks], z[kPacketLinks];
};

// A vertex at the ends of links, apart from the others: one load and one store move its position and its velocity.
struct alignas(64) SweptEnd {
  double x[4] = {};  // position, and 0 [m]
  double v[4] = {};  // velocity, and 0 [m/s]
};

// True if vertex b follows vertex a, so that their coordinates are contiguous.
constexpr bool IsPair(const Link& link) { return link.b == link.a + 1; }

// Packs the links in sequence, with indices from `first` on. The links of a packet have one sign, and either all are
// pairs or none is. With `in_blocks` (each link lies in one block of kVertexBlock vertices) a packet's links lie in one
// block, and offsets are relative to it.
std::vector<LinkPacket> PackLinks(absl::Span<const Link> links, int first, bool in_blocks);
// The same for links whose vertices are numbers of SweptEnds: the packets have their offsets, and none is of pairs.
std::vector<LinkPacket> PackSweptLinks(absl::Span<const Link> links, int first);

// Sets `directions` to the vectors from a to b of the packets' links [m]. `x` points to the vertex of offset 0.
void FindDirections(absl::Span<const LinkPacket> packets, const double* x, LinkVectors* directions);
void FindDirections(absl::Span<const LinkPacket> packets, const SweptEnd* ends, LinkVectors* directions);

struct Restored {
  std::uint64_t missed = 0;  // bit kPacketLinks p + i: link i of packet p is not restored
  double displacement = 0;   // largest displacement of a coordinate of an end [m]; NaN if any is NaN
};

// Restores the links of up to kPacketsTogether packets without common movable vertices: x [m] and v [m/s], from the
// vertex of offset 0, change as by Restore over dt [s] along these directions; limits that are not violated are left
// unchanged. Links that have turned too far for their
// direction are reported in `missed` and left unchanged. Thread-safe for packets without common vertices.
Restored RestorePackets(absl::Span<const LinkPacket> packets, const LinkVectors* directions, double dt, double* x,
                        double* v);
// The same for packets of PackSweptLinks, without the displacement. Returns Restored::missed.
std::uint64_t RestorePackets(absl::Span<const LinkPacket> packets, const LinkVectors* directions, double dt,
                             SweptEnd* ends);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_KERNEL_H_
