#include "server/mechanics/constraints/link_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/constraints/link_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kLinks>;
using Vector = hn::Vec<Tag>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));

// A vector for each link, by coordinates.
struct Triples {
  HWY_ALIGN double of[3][kLinks] = {};
};

HWY_INLINE Triples Between(const LinkPacket& packet, const double* x) {
  Triples between;
  for (int i = 0; i < packet.count; ++i) {
    for (int k = 0; k < 3; ++k) between.of[k][i] = x[packet.b[i] + k] - x[packet.a[i] + k];
  }
  return between;
}

HWY_INLINE Vector Dot(const Triples& p, const Triples& q, int first) {
  const Tag d;
  const auto product = [&](int k) { return hn::Mul(hn::Load(d, p.of[k] + first), hn::Load(d, q.of[k] + first)); };
  return hn::Add(hn::Add(product(0), product(1)), product(2));
}

// Impulses [kg m] along the directions for links from `first` on; 0 for those that do not reach, whose bits it returns.
HWY_INLINE unsigned Impulses(const LinkPacket& packet, const Triples& between, const Triples& direction, int first,
                             Triples& impulse) {
  const Tag d;
  const auto zero = hn::Zero(d);
  const auto excess = hn::Sub(Dot(between, between, first), hn::Load(d, packet.squared_length + first));
  const auto along = Dot(between, direction, first);
  const auto discriminant = hn::Sub(hn::Mul(along, along), hn::Mul(Dot(direction, direction, first), excess));
  const auto reaches = hn::And(hn::Gt(along, zero), hn::Ge(discriminant, zero));
  const auto sum = hn::Add(along, hn::Sqrt(hn::Max(discriminant, zero)));
  const auto part = hn::Div(excess, hn::IfThenElse(reaches, sum, hn::Set(d, 1.0)));
  const auto scale = hn::IfThenElseZero(reaches, hn::Mul(part, hn::Load(d, packet.reduced + first)));
  for (int k = 0; k < 3; ++k) hn::Store(hn::Mul(scale, hn::Load(d, direction.of[k] + first)), d, impulse.of[k] + first);
  unsigned missed = 0;
  HWY_ALIGN double flags[kLanes];
  hn::Store(hn::IfThenElseZero(reaches, hn::Set(d, 1.0)), d, flags);
  for (int i = 0; i < kLanes; ++i) missed |= (flags[i] == 0 ? 1U : 0U) << (first + i);
  return missed;
}

unsigned RestorePacketHere(const LinkPacket& packet, const double* before, double dt, double* x, double* v) {
  const Triples between = Between(packet, x), direction = Between(packet, before);
  Triples impulse;
  unsigned missed = 0;
  for (int first = 0; first < kLinks; first += kLanes) missed |= Impulses(packet, between, direction, first, impulse);
  const double rate = 1 / dt;
  for (int i = 0; i < packet.count; ++i) {
    const std::int64_t a = packet.a[i], b = packet.b[i];
    for (int k = 0; k < 3; ++k) {
      const double of_a = packet.inverse_a[i] * impulse.of[k][i], of_b = packet.inverse_b[i] * impulse.of[k][i];
      x[a + k] += of_a, v[a + k] += rate * of_a;
      x[b + k] -= of_b, v[b + k] -= rate * of_b;
    }
  }
  return missed & ((1U << packet.count) - 1);
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(RestorePacketHere);

std::vector<LinkPacket> PackLinks(const std::vector<Link>& links) {
  std::vector<LinkPacket> packets;
  for (const Link& link : links) {
    if (packets.empty() || packets.back().count == kLinks) packets.emplace_back();
    LinkPacket& packet = packets.back();
    const int i = packet.count++;
    packet.squared_length[i] = link.length * link.length;
    packet.inverse_a[i] = link.inverse_a;
    packet.inverse_b[i] = link.inverse_b;
    packet.reduced[i] = link.Movable() ? 1 / (link.inverse_a + link.inverse_b) : 0;
    packet.a[i] = 3 * static_cast<std::int64_t>(link.a);
    packet.b[i] = 3 * static_cast<std::int64_t>(link.b);
  }
  return packets;
}

unsigned RestorePacket(const LinkPacket& packet, const double* before, double dt, double* x, double* v) {
  return HWY_DYNAMIC_DISPATCH(RestorePacketHere)(packet, before, dt, x, v);
}

}  // namespace phrenic
#endif  // HWY_ONCE
