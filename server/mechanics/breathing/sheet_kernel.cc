#include "server/mechanics/breathing/sheet_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/breathing/sheet_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kSheetLanes = static_cast<int>(points::kLanes);

HWY_INLINE Vectors Minus(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vector Inner(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vectors SixthOfCross(const Vectors& a, const Vectors& b) {
  const auto sixth = hn::Set(Tag(), 1.0 / 6);
  return {hn::Mul(sixth, hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y))),
          hn::Mul(sixth, hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z))),
          hn::Mul(sixth, hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)))};
}

HWY_INLINE Vectors Same(const double* v) {
  const Tag d;
  return {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])};
}

// Sums in lanes of a packet, so that the order of additions does not depend on the vector width.
double SideAreas(const std::vector<TrianglePacket>& packets, const double* x, const double* apex,
                 const LinearField& field, double* areas) {
  const Tag d;
  const Vectors origin = Same(apex), slope = Same(field.slope);
  const auto third = hn::Set(d, 1.0 / 3), offset = hn::Set(d, field.offset);
  HWY_ALIGN double volume[kPacketTriangles] = {};
  for (const TrianglePacket& packet : packets) {
    for (int lane = 0; lane < kPacketTriangles; lane += kSheetLanes, areas += 4 * kSheetLanes) {
      const Vectors a = points::Transposed<true>(x, packet.a + lane), b = points::Transposed<true>(x, packet.b + lane),
                    c = points::Transposed<true>(x, packet.c + lane);
      const Vectors area = SixthOfCross(Minus(b, a), Minus(c, a));
      const Vector values = hn::Add(hn::Add(Inner(slope, a), Inner(slope, b)), Inner(slope, c));
      hn::StoreInterleaved4(area.x, area.y, area.z, hn::Sub(hn::Mul(third, values), offset), d, areas);
      const auto cone = Inner(Minus(a, origin), area);
      hn::Store(hn::Add(hn::Load(d, volume + lane), cone), d, volume + lane);
    }
  }
  double sum = 0;
  for (const double part : volume) sum += part;
  return sum;
}

std::array<double, 2> SetAreasHere(const SheetLayout& layout, const double* x, const double* apex,
                                   const LinearField& field, double* areas) {
  const double right = SideAreas(layout.packets[0], x, apex, field, areas);
  const double left =
      SideAreas(layout.packets[1], x, apex, field, areas + 4 * kPacketTriangles * layout.packets[0].size());
  return {right, left};
}

void GatherHere(const SheetLayout& layout, const double* areas, const double* x, const LinearField& field,
                double* slopes, double* push) {
  const std::size_t vertices = layout.first.size() - 1;
  for (std::size_t i = 0; i < vertices; ++i, x += 3, slopes += 3, push += 3) {
    double sum[3] = {}, weighted[3] = {};
    for (std::int32_t t = layout.first[i]; t < layout.first[i + 1]; ++t) {
      const double* const area = areas + layout.around[t];
      for (int k = 0; k < 3; ++k) sum[k] += area[k], weighted[k] += area[3] * area[k];
    }
    const double here = field.slope[0] * x[0] + field.slope[1] * x[1] + field.slope[2] * x[2] - field.offset;
    for (int k = 0; k < 3; ++k) slopes[k] = sum[k], push[k] = (here * sum[k] + 3 * weighted[k]) / 4;
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(SetAreasHere);
HWY_EXPORT(GatherHere);

std::array<double, 2> SetAreas(const SheetLayout& layout, const double* x, const double* apex, const LinearField& field,
                               double* areas) {
  return HWY_DYNAMIC_DISPATCH(SetAreasHere)(layout, x, apex, field, areas);
}

void GatherAreas(const SheetLayout& layout, const double* areas, const double* x, const LinearField& field,
                 double* slopes, double* push) {
  HWY_DYNAMIC_DISPATCH(GatherHere)(layout, areas, x + 3 * layout.first_vertex, field, slopes, push);
}

}  // namespace phrenic
#endif  // HWY_ONCE
