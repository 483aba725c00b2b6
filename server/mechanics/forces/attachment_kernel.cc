#include "server/mechanics/forces/attachment_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/attachment_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kPacketVertices>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));

// One coordinate of the pull on the vertices from lane `first` on.
HWY_INLINE void Pull(const CarriedPacket& packet, int first, const double* way, const double* velocity, double scale,
                     double* pull) {
  const Tag d;
  const auto x = hn::Load(d, packet.x + first), y = hn::Load(d, packet.y + first), z = hn::Load(d, packet.z + first);
  const auto of = [&](const double* column) {
    const auto xy = hn::Add(hn::Mul(hn::Set(d, column[0]), x), hn::Mul(hn::Set(d, column[3]), y));
    return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, column[6]), z)), hn::Set(d, column[9]));
  };
  const auto stiffness = hn::Load(d, packet.stiffness + first), damping = hn::Load(d, packet.damping + first);
  const auto sum = hn::Add(hn::Mul(stiffness, of(way)), hn::Mul(damping, of(velocity)));
  hn::Store(hn::Mul(hn::Set(d, scale), sum), d, pull + first);
}

void AddCarriedHere(const double* way, const double* velocity, double scale, const CarriedPacket* packet,
                    const CarriedPacket* end, double* f) {
  HWY_ALIGN double pull[3][kPacketVertices];
  for (; packet != end; ++packet) {
    for (int first = 0; first < kPacketVertices; first += kLanes) {
      for (int k = 0; k < 3; ++k) Pull(*packet, first, way + k, velocity + k, scale, pull[k]);
    }
    for (std::int64_t i = 0; i < packet->count; ++i) {
      for (int k = 0; k < 3; ++k) f[packet->place[i] + k] += pull[k][i];
    }
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddCarriedHere);

void AddCarried(const Pose& pose, double scale, const CarriedPacket* first, const CarriedPacket* end, double* f) {
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
