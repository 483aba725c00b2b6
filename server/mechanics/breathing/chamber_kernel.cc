#include "server/mechanics/breathing/chamber_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/breathing/chamber_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kLanes = static_cast<int>(points::kLanes);

// The corners of kLanes triangles, or their velocities. Loads nothing beyond them, because a body's last vertex may be
// the last of the state.
struct Corners {
  Vectors a, b, c;
};

HWY_INLINE Corners Fetch(const TrianglePacket& packet, int first, const double* x) {
  return {points::Transposed<true>(x, packet.a + first), points::Transposed<true>(x, packet.b + first),
          points::Transposed<true>(x, packet.c + first)};
}

// Returns the sum of the corners' third coordinates.
HWY_INLINE Vector Along(const Corners& h) { return hn::Add(hn::Add(h.a.z, h.b.z), h.c.z); }

// p_a (q_b - q_c) + p_b (q_c - q_a) + p_c (q_a - q_b), p and q along the plane's two axes: n.((b - a) x (c - a))
HWY_INLINE Vector Area(const Corners& p, const Corners& q) {
  const auto a = hn::Mul(p.a.x, hn::Sub(q.b.y, q.c.y)), b = hn::Mul(p.b.x, hn::Sub(q.c.y, q.a.y));
  return hn::Add(hn::Add(a, b), hn::Mul(p.c.x, hn::Sub(q.a.y, q.b.y)));
}

// One sum per lane of a packet, so that the order of additions does not depend on the vector width.
struct Lanes {
  HWY_ALIGN double of[kPacketTriangles] = {};

  HWY_INLINE void Add(int first, Vector what) {
    const Tag d;
    hn::Store(hn::Add(hn::Load(d, of + first), what), d, of + first);
  }
  double Sum() const { return ((of[0] + of[1]) + (of[2] + of[3])) + ((of[4] + of[5]) + (of[6] + of[7])); }
};

template <bool kFlow>
ChamberReading Sum(const std::vector<TrianglePacket>& packets, double height, const double* x, const double* v) {
  const auto offset = hn::Set(Tag(), 3 * height);
  Lanes volume, flow;
  for (const TrianglePacket& packet : packets) {
    for (int first = 0; first < kPacketTriangles; first += kLanes) {
      const Corners at = Fetch(packet, first, x);
      const auto heights = hn::Sub(Along(at), offset), area = Area(at, at);
      volume.Add(first, hn::Mul(heights, area));
      if constexpr (kFlow) {
        const Corners rate = Fetch(packet, first, v);
        const auto widening = hn::Add(Area(rate, at), Area(at, rate));
        flow.Add(first, hn::Add(hn::Mul(Along(rate), area), hn::Mul(heights, widening)));
      }
    }
  }
  return {volume.Sum() / 6, flow.Sum() / 6};
}

ChamberReading SumHere(const std::vector<TrianglePacket>& packets, double height, const double* x, const double* v) {
  return v == nullptr ? Sum<false>(packets, height, x, v) : Sum<true>(packets, height, x, v);
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(SumHere);

std::vector<TrianglePacket> PackTriangles(const Triangles& triangles) {
  std::vector<TrianglePacket> packets((static_cast<size_t>(triangles.cols()) + kPacketTriangles - 1) /
                                      kPacketTriangles);
  for (size_t i = 0; i < packets.size() * kPacketTriangles; ++i) {
    const auto t = static_cast<Eigen::Index>(i);
    const Eigen::Vector3i corners =
        t < triangles.cols() ? Eigen::Vector3i(triangles.col(t)) : Eigen::Vector3i::Constant(triangles(0, 0));
    TrianglePacket& packet = packets[i / kPacketTriangles];
    const size_t lane = i % kPacketTriangles;
    packet.a[lane] = 3 * corners[0], packet.b[lane] = 3 * corners[1], packet.c[lane] = 3 * corners[2];
  }
  return packets;
}

ChamberReading SumTriangles(const std::vector<TrianglePacket>& packets, double height, const double* x,
                            const double* v) {
  return HWY_DYNAMIC_DISPATCH(SumHere)(packets, height, x, v);
}

}  // namespace phrenic
#endif  // HWY_ONCE
