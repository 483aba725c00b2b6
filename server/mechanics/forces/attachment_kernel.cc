#include "server/mechanics/forces/attachment_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/attachment_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/points-inl.h"

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

// Calls pull(packet, first, stiffness, damping), of the vertices from lane `first` on, and adds what it returns to f.
template <typename Pull>
HWY_INLINE void AddPulls(const HoldPacket* packet, const HoldPacket* end, double* f, const Pull& pull) {
  const Tag d;
  for (; packet != end; ++packet) {
    for (int first = 0; first < packet->count; first += kLanes) {
      const auto stiffness = hn::Load(d, packet->stiffness + first), damping = hn::Load(d, packet->damping + first);
      const Vectors force = pull(*packet, first, stiffness, damping);
      points::AddRows(points::ToRows(force), packet->place + first, static_cast<int>(packet->count) - first, f);
    }
  }
}

void AddHeldHere(const HoldPacket* packet, const HoldPacket* end, const double* x, const double* v, double* f) {
  const auto pull = [&](const HoldPacket& of, int first, Vector stiffness, Vector damping) HWY_ATTR {
    const Vectors rest = AtRest(of, first);
    const Vectors at = points::Transposed<true>(x, of.place + first),
                  speed = points::Transposed<true>(v, of.place + first);
    const auto along = [&](Vector r, Vector p, Vector s)
                           HWY_ATTR { return hn::Sub(hn::Mul(stiffness, hn::Sub(r, p)), hn::Mul(damping, s)); };
    return Vectors{along(rest.x, at.x, speed.x), along(rest.y, at.y, speed.y), along(rest.z, at.z, speed.z)};
  };
  AddPulls(packet, end, f, pull);
}

// One coordinate of where an affine map, 3 x 4, takes points.
HWY_INLINE Vector Mapped(const double* row, const Vectors& p) {
  const Tag d;
  const auto xy = hn::Add(hn::Mul(hn::Set(d, row[0]), p.x), hn::Mul(hn::Set(d, row[3]), p.y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, row[6]), p.z)), hn::Set(d, row[9]));
}

void AddCarriedHere(const double* way, const double* velocity, double scale, const HoldPacket* packet,
                    const HoldPacket* end, double* f) {
  const auto pull = [&](const HoldPacket& of, int first, Vector stiffness, Vector damping) HWY_ATTR {
    const Vectors rest = AtRest(of, first);
    const auto along = [&](int k) HWY_ATTR {
      const auto sum = hn::Add(hn::Mul(stiffness, Mapped(way + k, rest)), hn::Mul(damping, Mapped(velocity + k, rest)));
      return hn::Mul(hn::Set(Tag(), scale), sum);
    };
    return Vectors{along(0), along(1), along(2)};
  };
  AddPulls(packet, end, f, pull);
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

void AddCarried(const Pose& pose, double scale, const HoldPacket* first, const HoldPacket* end, double* f) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  // The point's way and its velocity: a column for each of its coordinates at rest, and one that is the same for all.
  Eigen::Matrix<double, 3, 4> way, velocity;
  way.leftCols<3>() = rotation - Eigen::Matrix3d::Identity();
  way.col(3) = pose.translation;
  for (int c = 0; c < 3; ++c) velocity.col(c) = pose.angular_velocity.cross(rotation.col(c));
  velocity.col(3) = pose.velocity;
  HWY_DYNAMIC_DISPATCH(AddCarriedHere)(way.data(), velocity.data(), scale, first, end, f);
}

}  // namespace phrenic
#endif  // HWY_ONCE
