#include "server/mechanics/constraints/link_kernel.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "server/mechanics/linalg/vector_targets.h"
#include "server/mechanics/parallel/vertex_range.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/constraints/link_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kLanes = static_cast<int>(points::kLanes);

// Returns the vectors from a to b of kLanes links. Reads only their ends, because another thread may be writing
// adjacent vertices; ends that are apart have four numbers.
template <bool kApart>
HWY_INLINE Vectors Between(const LinkPacket& packet, int first, const double* x) {
#if HWY_TARGET <= HWY_AVX2
  const hn::FixedTag<double, 4> four;
  const auto end = [&](const std::int32_t* offset) HWY_ATTR {
    return kApart ? hn::Load(four, x + *offset) : hn::MaskedLoad(hn::FirstN(four, 3), four, x + *offset);
  };
  return points::Columns([&](int i) HWY_ATTR { return hn::Sub(end(packet.b + first + i), end(packet.a + first + i)); });
#else
  const Vectors a = points::Transposed<true>(x, packet.a + first), b = points::Transposed<true>(x, packet.b + first);
  return {hn::Sub(b.x, a.x), hn::Sub(b.y, a.y), hn::Sub(b.z, a.z)};
#endif
}

HWY_INLINE Vector Dot(const Vectors& p, const Vectors& q) {
  return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
}

HWY_INLINE Vectors Scaled(Vector factor, const Vectors& by) {
  return {hn::Mul(factor, by.x), hn::Mul(factor, by.y), hn::Mul(factor, by.z)};
}

HWY_INLINE Vectors Loaded(const LinkVectors& of, int first) {
  const Tag d;
  return {hn::Load(d, of.x + first), hn::Load(d, of.y + first), hn::Load(d, of.z + first)};
}
HWY_INLINE void Store(const Vectors& v, int first, LinkVectors& to) {
  const Tag d;
  hn::Store(v.x, d, to.x + first), hn::Store(v.y, d, to.y + first), hn::Store(v.z, d, to.z + first);
}

template <bool kApart>
HWY_INLINE void FindAll(const LinkPacket* packets, int count, const double* x, LinkVectors* directions) {
  for (int p = 0; p < count; ++p) {
    for (int first = 0; first < packets[p].count; first += kLanes) {
      Store(Between<kApart>(packets[p], first, x), first, directions[p]);
    }
  }
}

void FindDirectionsHere(const LinkPacket* packets, int count, const double* x, LinkVectors* directions) {
  FindAll<false>(packets, count, x, directions);
}

void FindDirectionsOfEnds(const LinkPacket* packets, int count, const SweptEnd* ends, LinkVectors* directions) {
  FindAll<true>(packets, count, ends->x, directions);
}

// Of links in their order, a bit each.
struct Corrected {
  std::uint64_t missed = 0;  // have turned too far
  bool move = false;         // any has an impulse that is not 0
};

// Computes the impulses that restore the links from `first` on [kg m]: 0 for links that have turned too far.
template <bool kApart>
HWY_INLINE Corrected Correct(const LinkPacket& packet, int first, const LinkVectors& directions, const double* x,
                             LinkVectors& impulses) {
  const Tag d;
  const auto zero = hn::Zero(d);
  const Vectors between = Between<kApart>(packet, first, x), direction = Loaded(directions, first);
  const auto excess = hn::Sub(Dot(between, between), hn::Load(d, packet.squared_length + first));
  const auto along = Dot(between, direction);
  const auto discriminant = hn::Sub(hn::Mul(along, along), hn::Mul(Dot(direction, direction), excess));
  const auto reaches = hn::And(hn::Gt(along, zero), hn::Ge(discriminant, zero));
  const auto sum = hn::Add(along, hn::Sqrt(hn::Max(discriminant, zero)));
  const auto inverse_mass = hn::Add(hn::Load(d, packet.inverse_a + first), hn::Load(d, packet.inverse_b + first));
  const auto off = packet.sign == 0 ? hn::Ge(inverse_mass, zero)
                                    : hn::Gt(hn::Mul(hn::Set(d, static_cast<double>(packet.sign)), excess), zero);
  const auto moves = hn::And(hn::And(reaches, off), hn::Gt(inverse_mass, zero));
  const auto by = hn::IfThenElse(moves, hn::Mul(sum, inverse_mass), hn::Set(d, 1.0));
  const auto scale = hn::IfThenElseZero(moves, hn::Mul(hn::Div(excess, by), hn::Set(d, packet.relaxation)));
  Store(Scaled(scale, direction), first, impulses);
  std::uint8_t missed[8];
  hn::StoreMaskBits(d, hn::AndNot(reaches, off), missed);
  return {static_cast<std::uint64_t>(*missed) << first, !hn::AllFalse(d, moves)};
}

// Adds the displacements of one end of kLanes links to x, and displacement times `rate` to v.
HWY_INLINE void MoveEnds(Vector inverse_mass, const Vectors& impulse, double rate, const std::int32_t* offset,
                         int count, double* x, double* v, points::Largest& largest) {
  const Vectors displacement = Scaled(inverse_mass, impulse);
  largest.Note(displacement);
  points::AddRows(points::ToRows(displacement), offset, count, x);
  points::AddRows(points::ToRows(Scaled(hn::Set(Tag(), rate), displacement)), offset, count, v);
}

HWY_INLINE void Move(const LinkPacket& packet, int first, const LinkVectors& impulses, double rate, double* x,
                     double* v, points::Largest& largest) {
  const Tag d;
  const Vectors impulse = Loaded(impulses, first);
  const int count = packet.count - first;
  MoveEnds(hn::Load(d, packet.inverse_a + first), impulse, rate, packet.a + first, count, x, v, largest);
  MoveEnds(hn::Neg(hn::Load(d, packet.inverse_b + first)), impulse, rate, packet.b + first, count, x, v, largest);
}

#if HWY_TARGET <= HWY_AVX2
// Adds a displacement to coordinates of a pair's ends, and displacement times rate to their velocities. Stores exactly
// these numbers: a wider store would delay the following loads of adjacent numbers.
template <class D>
HWY_INLINE void MovePart(D d, hn::Vec<D> displacement, hn::Vec<D> rate, double* x, double* v) {
  hn::StoreU(hn::Add(hn::LoadU(d, x), displacement), d, x);
  hn::StoreU(hn::Add(hn::LoadU(d, v), hn::Mul(rate, displacement)), d, v);
}

// Moves both ends of one pair by xyzx = (xa, ya, za, xb) and yz = (yb, zb).
HWY_INLINE void MovePair(hn::Vec<hn::FixedTag<double, 4>> xyzx, hn::Vec<hn::FixedTag<double, 2>> yz, double rate,
                         const LinkPacket& packet, int link, double* x, double* v) {
  if (link >= packet.count) return;
  const hn::FixedTag<double, 4> four;
  const hn::FixedTag<double, 2> two;
  const std::int32_t offset = packet.a[link];
  MovePart(four, xyzx, hn::Set(four, rate), x + offset, v + offset);
  MovePart(two, yz, hn::Set(two, rate), x + offset + 4, v + offset + 4);
}

// Moves every second pair from `first` on, within one vector. Each 128-bit block of p has a pair's (xa, ya), of q
// (za, xb), of r (yb, zb).
HWY_INLINE void MoveEverySecond(Vector p, Vector q, Vector r, double rate, const LinkPacket& packet, int first,
                                double* x, double* v) {
  const hn::FixedTag<double, 2> two;
#if HWY_TARGET <= HWY_AVX3
  const hn::FixedTag<double, 4> four;
  const Vector even = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(q), p);
  const Vector odd = hn::OddEvenBlocks(q, hn::SwapAdjacentBlocks(p));
  const auto low = hn::LowerHalf(four, r), high = hn::UpperHalf(four, r);
  MovePair(hn::LowerHalf(four, even), hn::LowerHalf(two, low), rate, packet, first, x, v);
  MovePair(hn::LowerHalf(four, odd), hn::UpperHalf(two, low), rate, packet, first + 2, x, v);
  MovePair(hn::UpperHalf(four, even), hn::LowerHalf(two, high), rate, packet, first + 4, x, v);
  MovePair(hn::UpperHalf(four, odd), hn::UpperHalf(two, high), rate, packet, first + 6, x, v);
#else
  const Tag d;
  MovePair(hn::ConcatLowerLower(d, q, p), hn::LowerHalf(two, r), rate, packet, first, x, v);
  MovePair(hn::ConcatUpperUpper(d, q, p), hn::UpperHalf(two, r), rate, packet, first + 2, x, v);
#endif
}

// Moves the pairs from `first` on. Loads and stores both ends of a link together.
HWY_INLINE void MovePairs(const LinkPacket& packet, int first, const LinkVectors& impulses, double rate, double* x,
                          double* v, points::Largest& largest) {
  const Tag d;
  const Vectors impulse = Loaded(impulses, first);
  const Vectors a = Scaled(hn::Load(d, packet.inverse_a + first), impulse);
  const Vectors b = Scaled(hn::Neg(hn::Load(d, packet.inverse_b + first)), impulse);
  largest.Note(a), largest.Note(b);
  MoveEverySecond(hn::InterleaveLower(d, a.x, a.y), hn::InterleaveLower(d, a.z, b.x), hn::InterleaveLower(d, b.y, b.z),
                  rate, packet, first, x, v);
  MoveEverySecond(hn::InterleaveUpper(d, a.x, a.y), hn::InterleaveUpper(d, a.z, b.x), hn::InterleaveUpper(d, b.y, b.z),
                  rate, packet, first + 1, x, v);
}
#endif

HWY_INLINE void MoveAll(const LinkPacket& packet, const LinkVectors& impulses, double rate, double* x, double* v,
                        points::Largest& largest) {
  for (int first = 0; first < packet.count; first += kLanes) {
#if HWY_TARGET <= HWY_AVX2
    if (packet.pairs) {
      MovePairs(packet, first, impulses, rate, x, v, largest);
      continue;
    }
#endif
    Move(packet, first, impulses, rate, x, v, largest);
  }
}

// Computes the impulses of all packets before it moves any vertex: the latencies of square roots and divisions overlap.
Restored RestorePacketsHere(const LinkPacket* packets, int count, const LinkVectors* directions, double dt, double* x,
                            double* v) {
  LinkVectors impulses[kPacketsTogether];
  std::uint64_t missed = 0;
  points::Largest largest;
  for (int p = 0; p < count; ++p) {
    std::uint64_t of_packet = 0;
    for (int first = 0; first < packets[p].count; first += kLanes) {
      of_packet |= Correct<false>(packets[p], first, directions[p], x, impulses[p]).missed;
    }
    missed |= (of_packet & ((1U << packets[p].count) - 1)) << (p * kPacketLinks);
  }
  for (int p = 0; p < count; ++p) MoveAll(packets[p], impulses[p], 1 / dt, x, v, largest);
  return {missed, largest.Whole()};
}

// Adds an impulse (x, y, z, 0) times an inverse mass to the position of an end, and times `rate` to its velocity.
HWY_INLINE void MoveEnd(double inverse_mass, const double* impulse, double rate, double* end) {
#if HWY_TARGET <= HWY_AVX3
  const hn::FixedTag<double, 4> four;
  const hn::FixedTag<double, 8> eight;
  const auto both = hn::Combine(eight, hn::Load(four, impulse), hn::Load(four, impulse));
  const auto rates = hn::Combine(eight, hn::Set(four, rate), hn::Set(four, 1.0));
  const auto displacement = hn::Mul(hn::Set(eight, inverse_mass), both);
  hn::Store(hn::Add(hn::Load(eight, end), hn::Mul(rates, displacement)), eight, end);
#else
  const hn::CappedTag<double, 4> d;
  for (size_t k = 0; k < 4; k += hn::Lanes(d)) {
    const auto displacement = hn::Mul(hn::Set(d, inverse_mass), hn::Load(d, impulse + k));
    hn::Store(hn::Add(hn::Load(d, end + k), displacement), d, end + k);
    hn::Store(hn::Add(hn::Load(d, end + 4 + k), hn::Mul(hn::Set(d, rate), displacement)), d, end + 4 + k);
  }
#endif
}

HWY_INLINE void MoveApart(const LinkPacket& packet, int first, const LinkVectors& impulses, double rate,
                          double* numbers) {
  const Tag d;
  HWY_ALIGN double rows[4 * kLanes];
  const Vectors impulse = Loaded(impulses, first);
  hn::StoreInterleaved4(impulse.x, impulse.y, impulse.z, hn::Zero(d), d, rows);
  const auto move = [&](int i) HWY_ATTR {
    MoveEnd(packet.inverse_a[first + i], rows + 4 * i, rate, numbers + packet.a[first + i]);
    MoveEnd(-packet.inverse_b[first + i], rows + 4 * i, rate, numbers + packet.b[first + i]);
  };
  const int count = std::min(kLanes, packet.count - first);
  for (int i = 0; i < count; ++i) move(i);
}

std::uint64_t RestoreEndsHere(const LinkPacket* packets, int count, const LinkVectors* directions, double dt,
                              SweptEnd* ends) {
  double* const numbers = ends->x;
  LinkVectors impulses[kPacketsTogether];
  std::uint64_t missed = 0, move = 0;  // move: a bit for every kLanes links
  for (int p = 0; p < count; ++p) {
    std::uint64_t of_packet = 0;
    for (int first = 0; first < packets[p].count; first += kLanes) {
      const Corrected part = Correct<true>(packets[p], first, directions[p], numbers, impulses[p]);
      of_packet |= part.missed;
      move |= static_cast<std::uint64_t>(part.move) << (p * kPacketLinks + first);
    }
    missed |= (of_packet & ((1U << packets[p].count) - 1)) << (p * kPacketLinks);
  }
  for (; move != 0; move &= move - 1) {
    const int bit = std::countr_zero(move), p = bit / kPacketLinks;
    MoveApart(packets[p], bit % kPacketLinks, impulses[p], 1 / dt, numbers);
  }
  return missed;
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(FindDirectionsHere);
HWY_EXPORT(FindDirectionsOfEnds);
HWY_EXPORT(RestorePacketsHere);
HWY_EXPORT(RestoreEndsHere);

namespace {

// Adds a link, between vertices at offsets a and b, to the last packet.
void AddToPacket(const Link& link, int a, int b, LinkPacket& packet) {
  const int i = packet.count++;
  packet.squared_length[i] = link.length * link.length;
  packet.inverse_a[i] = link.inverse_a;
  packet.inverse_b[i] = link.inverse_b;
  // Padding lanes read the last link's ends.
  std::fill(packet.a + i, std::end(packet.a), a);
  std::fill(packet.b + i, std::end(packet.b), b);
}

}  // namespace

std::vector<LinkPacket> PackLinks(absl::Span<const Link> links, int first, bool in_blocks) {
  std::vector<LinkPacket> packets;
  for (size_t next = 0; next < links.size(); ++next) {
    const Link& link = links[next];
    const bool same_group = next > 0 && packets.back().pairs == IsPair(link) && packets.back().sign == link.sign &&
                            (!in_blocks || links[next - 1].a / kVertexBlock == link.a / kVertexBlock);
    if (!same_group || packets.back().count == kPacketLinks) {
      packets.push_back({.first = first + static_cast<int>(next), .pairs = IsPair(link), .sign = link.sign});
    }
    const int from = in_blocks ? static_cast<int>(link.a / kVertexBlock * kVertexBlock) : 0;
    AddToPacket(link, 3 * (link.a - from), 3 * (link.b - from), packets.back());
  }
  return packets;
}

std::vector<LinkPacket> PackSweptLinks(absl::Span<const Link> links, int first) {
  constexpr int kNumbers = sizeof(SweptEnd) / sizeof(double);
  std::vector<LinkPacket> packets;
  for (size_t next = 0; next < links.size(); ++next) {
    const Link& link = links[next];
    if (next == 0 || packets.back().sign != link.sign || packets.back().count == kPacketLinks) {
      packets.push_back({.first = first + static_cast<int>(next), .sign = link.sign});
    }
    AddToPacket(link, kNumbers * link.a, kNumbers * link.b, packets.back());
  }
  return packets;
}

void FindDirections(absl::Span<const LinkPacket> packets, const double* x, LinkVectors* directions) {
  HWY_DYNAMIC_DISPATCH(FindDirectionsHere)(packets.data(), static_cast<int>(packets.size()), x, directions);
}

void FindDirections(absl::Span<const LinkPacket> packets, const SweptEnd* ends, LinkVectors* directions) {
  HWY_DYNAMIC_DISPATCH(FindDirectionsOfEnds)(packets.data(), static_cast<int>(packets.size()), ends, directions);
}

Restored RestorePackets(absl::Span<const LinkPacket> packets, const LinkVectors* directions, double dt, double* x,
                        double* v) {
  const auto count = static_cast<int>(packets.size());
  return HWY_DYNAMIC_DISPATCH(RestorePacketsHere)(packets.data(), count, directions, dt, x, v);
}

std::uint64_t RestorePackets(absl::Span<const LinkPacket> packets, const LinkVectors* directions, double dt,
                             SweptEnd* ends) {
  const auto count = static_cast<int>(packets.size());
  return HWY_DYNAMIC_DISPATCH(RestoreEndsHere)(packets.data(), count, directions, dt, ends);
}

}  // namespace phrenic
#endif  // HWY_ONCE
