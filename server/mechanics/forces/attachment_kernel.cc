#include "server/mechanics/forces/attachment_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/attachment_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kLanes = static_cast<int>(points::kLanes);
static_assert(kPacketVertices % kLanes == 0);

HWY_INLINE Vectors AtRest(const HoldPacket& packet, int first) {
  const Tag d;
  return {hn::Load(d, packet.x + first), hn::Load(d, packet.y + first), hn::Load(d, packet.z + first)};
}

// Adds force_of(packet, first, stiffness, damping), the forces on the vertices from lane `first` on, to f.
template <typename ForceOf>
HWY_INLINE void AddForces(const HoldPacket* packet, const HoldPacket* end, double* f, const ForceOf& force_of) {
  const Tag d;
  for (; packet != end; ++packet) {
    for (int first = 0; first < packet->count; first += kLanes) {
      const auto stiffness = hn::Load(d, packet->stiffness + first), damping = hn::Load(d, packet->damping + first);
      const Vectors force = force_of(*packet, first, stiffness, damping);
      points::AddRows(points::ToRows(force), packet->offset + first, packet->count - first, f);
    }
  }
}

void AddHeldHere(const HoldPacket* packet, const HoldPacket* end, const double* x, const double* v, double* f) {
  const auto force_of = [&](const HoldPacket& of, int first, Vector stiffness, Vector damping) HWY_ATTR {
    const Vectors rest = AtRest(of, first);
    const Vectors at = points::Transposed<true>(x, of.offset + first),
                  speed = points::Transposed<true>(v, of.offset + first);
    const auto along = [&](Vector r, Vector p, Vector s)
                           HWY_ATTR { return hn::Sub(hn::Mul(stiffness, hn::Sub(r, p)), hn::Mul(damping, s)); };
    return Vectors{along(rest.x, at.x, speed.x), along(rest.y, at.y, speed.y), along(rest.z, at.z, speed.z)};
  };
  AddForces(packet, end, f, force_of);
}

// Row `row` of the pose's matrix, applied to points: row 0 to 2 a displacement [m], row 4 to 6 a velocity [m/s].
HWY_INLINE Vector Mapped(const PoseMatrices& pose, int row, const Vectors& p) {
  const Tag d;
  const auto of = [&](int c) HWY_ATTR { return hn::Set(d, pose.column[c][row]); };
  const auto xy = hn::Add(hn::Mul(of(0), p.x), hn::Mul(of(1), p.y));
  return hn::Add(hn::Add(xy, hn::Mul(of(2), p.z)), of(3));
}

void AddCarriedHere(const PoseMatrices& pose, double scale, const HoldPacket* packet, const HoldPacket* end,
                    double* f) {
  const auto force_of = [&](const HoldPacket& of, int first, Vector stiffness, Vector damping) HWY_ATTR {
    const Vectors rest = AtRest(of, first);
    const auto along = [&](int k) HWY_ATTR {
      const auto sum = hn::Add(hn::Mul(stiffness, Mapped(pose, k, rest)), hn::Mul(damping, Mapped(pose, 4 + k, rest)));
      return hn::Mul(hn::Set(Tag(), scale), sum);
    };
    return Vectors{along(0), along(1), along(2)};
  };
  AddForces(packet, end, f, force_of);
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddHeldHere);
HWY_EXPORT(AddCarriedHere);

void AddHeld(const HoldPacket* first, const HoldPacket* end, const double* x, const double* v, double* f) {
  HWY_DYNAMIC_DISPATCH(AddHeldHere)(first, end, x, v, f);
}

void AddCarried(const PoseMatrices& pose, double scale, const HoldPacket* first, const HoldPacket* end, double* f) {
  HWY_DYNAMIC_DISPATCH(AddCarriedHere)(pose, scale, first, end, f);
}

}  // namespace phrenic
#endif  // HWY_ONCE
