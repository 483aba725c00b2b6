#include "server/mechanics/constraints/link_kernel.h"

#include <algorithm>
#include <iterator>

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/constraints/link_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kLanes = static_cast<int>(points::kLanes);

// From a to b of kLanes links. Reads their ends alone: what lies beside may be another thread's.
HWY_INLINE Vectors Between(const LinkPacket& packet, int first, const double* x) {
  const Vectors a = points::Transposed<true>(x, packet.a + first), b = points::Transposed<true>(x, packet.b + first);
  return {hn::Sub(b.x, a.x), hn::Sub(b.y, a.y), hn::Sub(b.z, a.z)};
}

HWY_INLINE Vector Dot(const Vectors& p, const Vectors& q) {
  return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
}

HWY_INLINE Vectors Scaled(Vector factor, const Vectors& by) {
  return {hn::Mul(factor, by.x), hn::Mul(factor, by.y), hn::Mul(factor, by.z)};
}

// What pulls a packet's links back [kg m].
struct Impulses {
  HWY_ALIGN double x[kPacketLinks], y[kPacketLinks], z[kPacketLinks];
};

// Of links from `first` on. Those that do not reach get none, and it returns their bits.
HWY_INLINE std::uint64_t Correct(const LinkPacket& packet, int first, const double* before, const double* x,
                                 Impulses& impulses) {
  const Tag d;
  const auto zero = hn::Zero(d);
  const Vectors between = Between(packet, first, x), direction = Between(packet, first, before);
  const auto excess = hn::Sub(Dot(between, between), hn::Load(d, packet.squared_length + first));
  const auto along = Dot(between, direction);
  const auto discriminant = hn::Sub(hn::Mul(along, along), hn::Mul(Dot(direction, direction), excess));
  const auto reaches = hn::And(hn::Gt(along, zero), hn::Ge(discriminant, zero));
  const auto sum = hn::Add(along, hn::Sqrt(hn::Max(discriminant, zero)));
  const auto part = hn::Div(excess, hn::IfThenElse(reaches, sum, hn::Set(d, 1.0)));
  const auto scale = hn::IfThenElseZero(reaches, hn::Mul(part, hn::Load(d, packet.reduced + first)));
  const Vectors impulse = Scaled(scale, direction);
  hn::Store(impulse.x, d, impulses.x + first);
  hn::Store(impulse.y, d, impulses.y + first);
  hn::Store(impulse.z, d, impulses.z + first);
  std::uint8_t missed[8];
  hn::StoreMaskBits(d, hn::Not(reaches), missed);
  return static_cast<std::uint64_t>(*missed) << first;
}

// Moves one end of links from `first` on, and their velocities.
HWY_INLINE void MoveEnds(Vector inverse_mass, const Vectors& impulse, double rate, const std::int64_t* place, int count,
                         double* x, double* v) {
  const Vectors way = Scaled(inverse_mass, impulse);
  points::AddRows(points::ToRows(way), place, count, x);
  points::AddRows(points::ToRows(Scaled(hn::Set(Tag(), rate), way)), place, count, v);
}

HWY_INLINE void Move(const LinkPacket& packet, int first, const Impulses& impulses, double rate, double* x, double* v) {
  const Tag d;
  const Vectors impulse = {hn::Load(d, impulses.x + first), hn::Load(d, impulses.y + first),
                           hn::Load(d, impulses.z + first)};
  const int count = packet.count - first;
  MoveEnds(hn::Load(d, packet.inverse_a + first), impulse, rate, packet.a + first, count, x, v);
  MoveEnds(hn::Neg(hn::Load(d, packet.inverse_b + first)), impulse, rate, packet.b + first, count, x, v);
}

// All roots and divisions first: what one packet waits for, the next does not.
std::uint64_t RestorePacketsHere(const LinkPacket* packets, int count, const double* before, double dt, double* x,
                                 double* v) {
  Impulses impulses[kPacketsTogether];
  std::uint64_t missed = 0;
  for (int p = 0; p < count; ++p) {
    std::uint64_t of_packet = 0;
    for (int first = 0; first < packets[p].count; first += kLanes) {
      of_packet |= Correct(packets[p], first, before, x, impulses[p]);
    }
    missed |= (of_packet & ((1U << packets[p].count) - 1)) << (p * kPacketLinks);
  }
  for (int p = 0; p < count; ++p) {
    for (int first = 0; first < packets[p].count; first += kLanes) Move(packets[p], first, impulses[p], 1 / dt, x, v);
  }
  return missed;
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(RestorePacketsHere);

std::vector<LinkPacket> PackLinks(absl::Span<const Link> links, int first, bool in_blocks) {
  std::vector<LinkPacket> packets;
  for (size_t next = 0; next < links.size(); ++next) {
    const Link& link = links[next];
    const bool goes_on = next > 0 && links[next - 1].a / kVertexBlock == link.a / kVertexBlock;
    if (!goes_on || packets.back().count == kPacketLinks) packets.push_back({.first = first + static_cast<int>(next)});
    LinkPacket& packet = packets.back();
    const int i = packet.count++;
    packet.squared_length[i] = link.length * link.length;
    packet.inverse_a[i] = link.inverse_a;
    packet.inverse_b[i] = link.inverse_b;
    packet.reduced[i] = link.Movable() ? 1 / (link.inverse_a + link.inverse_b) : 0;
    // Lanes that stay empty read the last link's ends.
    const std::int64_t from = in_blocks ? link.a / kVertexBlock * kVertexBlock : 0;
    std::fill(packet.a + i, std::end(packet.a), 3 * (link.a - from));
    std::fill(packet.b + i, std::end(packet.b), 3 * (link.b - from));
  }
  return packets;
}

std::uint64_t RestorePackets(absl::Span<const LinkPacket> packets, const double* before, double dt, double* x,
                             double* v) {
  return HWY_DYNAMIC_DISPATCH(RestorePacketsHere)(packets.data(), static_cast<int>(packets.size()), before, dt, x, v);
}

}  // namespace phrenic
#endif  // HWY_ONCE
