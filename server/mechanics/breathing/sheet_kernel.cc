#include "server/mechanics/breathing/sheet_kernel.h"

#include <algorithm>

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
    for (int lane = 0; lane < kPacketTriangles; lane += kSheetLanes) {
      const Vectors a = points::Transposed<true>(x, packet.a + lane), b = points::Transposed<true>(x, packet.b + lane),
                    c = points::Transposed<true>(x, packet.c + lane);
      const Vectors area = SixthOfCross(Minus(b, a), Minus(c, a));
      const Vector values = hn::Add(hn::Add(Inner(slope, a), Inner(slope, b)), Inner(slope, c));
      hn::StoreInterleaved4(area.x, area.y, area.z, hn::Sub(hn::Mul(third, values), offset), d, areas + 4 * lane);
      const auto cone = Inner(Minus(a, origin), area);
      hn::Store(hn::Add(hn::Load(d, volume + lane), cone), d, volume + lane);
    }
    areas += 4 * kPacketTriangles;
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

// Sets the four numbers of a vertex's slopes and push; the fourth of each has no meaning.
HWY_INLINE void GatherAround(const std::int32_t* first, const std::int32_t* end, const double* areas, double here,
                             double* slopes, double* push) {
  const hn::CappedTag<double, 4> d;
  constexpr size_t kParts = 4 / hn::MaxLanes(d);
  hn::Vec<decltype(d)> sums[kParts], products[kParts];
  for (size_t k = 0; k < kParts; ++k) sums[k] = products[k] = hn::Zero(d);
  for (; first < end; first += kRingPlaces) {
#pragma GCC unroll 8
    for (int t = 0; t < kRingPlaces; ++t) {
      const double* const at = areas + first[t];
      for (size_t k = 0; k < kParts; ++k) {
        const auto area = hn::Load(d, at + k * hn::Lanes(d));
        sums[k] = hn::Add(sums[k], area);
        products[k] = hn::Add(products[k], hn::Mul(hn::Set(d, at[3]), area));
      }
    }
  }
  const auto pressure = hn::Set(d, here), three = hn::Set(d, 3.0), quarter = hn::Set(d, 0.25);
  for (size_t k = 0; k < kParts; ++k) {
    hn::StoreU(sums[k], d, slopes + k * hn::Lanes(d));
    hn::StoreU(hn::Mul(hn::Add(hn::Mul(pressure, sums[k]), hn::Mul(three, products[k])), quarter), d,
               push + k * hn::Lanes(d));
  }
}

void GatherHere(const SheetLayout& layout, const double* areas, const double* x, const LinearField& field,
                double* slopes, double* push) {
  const std::size_t vertices = layout.first.size() - 1;
  const std::int32_t* const around = layout.around.data();  // a last vertex may have no triangle
  const auto gather = [&](std::size_t i, double* of_slopes, double* of_push) HWY_ATTR {
    const double* const at = x + 3 * i;
    const double here = field.slope[0] * at[0] + field.slope[1] * at[1] + field.slope[2] * at[2] - field.offset;
    GatherAround(around + layout.first[i], around + layout.first[i + 1], areas, here, of_slopes, of_push);
  };
  // The fourth number of a vertex lies where the first of the next will.
  for (std::size_t i = 0; i + 1 < vertices; ++i) gather(i, slopes + 3 * i, push + 3 * i);
  if (vertices == 0) return;
  double last_slopes[4], last_push[4];
  gather(vertices - 1, last_slopes, last_push);
  std::copy_n(last_slopes, 3, slopes + 3 * (vertices - 1));
  std::copy_n(last_push, 3, push + 3 * (vertices - 1));
}

constexpr std::size_t kSumLanes = 8;  // sums that stay apart, so that the order of additions is one

std::array<double, 2> SumBySideHere(const std::vector<double>& on_left, const double* a, const double* b) {
  const Tag d;
  double all[kSumLanes] = {}, left[kSumLanes] = {};
  const std::size_t whole = on_left.size() / kSumLanes * kSumLanes;
  for (std::size_t i = 0; i < whole; i += points::kLanes) {
    double *const to = all + i % kSumLanes, *const to_left = left + i % kSumLanes;
    const Vector product = hn::Mul(hn::LoadU(d, a + i), hn::LoadU(d, b + i));
    hn::StoreU(hn::Add(hn::LoadU(d, to), product), d, to);
    hn::StoreU(hn::Add(hn::LoadU(d, to_left), hn::Mul(product, hn::LoadU(d, &on_left[i]))), d, to_left);
  }
  for (std::size_t i = whole; i < on_left.size(); ++i) {
    all[i - whole] += a[i] * b[i];
    left[i - whole] += a[i] * b[i] * on_left[i];
  }
  double sum = 0, sum_left = 0;
  for (std::size_t lane = 0; lane < kSumLanes; ++lane) sum += all[lane], sum_left += left[lane];
  return {sum - sum_left, sum_left};
}

template <bool kAdd>
HWY_INLINE void WithSides(const std::vector<double>& on_left, double right, double left, const double* values,
                          double* to) {
  const Tag d;
  const std::size_t whole = on_left.size() / points::kLanes * points::kLanes;
  const Vector on_right = hn::Set(d, right), more = hn::Set(d, left - right);
  for (std::size_t i = 0; i < whole; i += points::kLanes) {
    const Vector factor = hn::Add(on_right, hn::Mul(more, hn::LoadU(d, &on_left[i])));
    const Vector product = hn::Mul(factor, hn::LoadU(d, values + i));
    hn::StoreU(kAdd ? hn::Add(hn::LoadU(d, to + i), product) : product, d, to + i);
  }
  for (std::size_t i = whole; i < on_left.size(); ++i) {
    const double product = (right + (left - right) * on_left[i]) * values[i];
    to[i] = kAdd ? to[i] + product : product;
  }
}

void AddBySideHere(const std::vector<double>& on_left, double right, double left, const double* values, double* to) {
  WithSides<true>(on_left, right, left, values, to);
}

void SetBySideHere(const std::vector<double>& on_left, double right, double left, const double* values, double* to) {
  WithSides<false>(on_left, right, left, values, to);
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(SetAreasHere);
HWY_EXPORT(GatherHere);
HWY_EXPORT(SumBySideHere);
HWY_EXPORT(AddBySideHere);
HWY_EXPORT(SetBySideHere);

std::array<double, 2> SetAreas(const SheetLayout& layout, const double* x, const double* apex, const LinearField& field,
                               double* areas) {
  return HWY_DYNAMIC_DISPATCH(SetAreasHere)(layout, x, apex, field, areas);
}

void GatherAreas(const SheetLayout& layout, const double* areas, const double* x, const LinearField& field,
                 double* slopes, double* push) {
  HWY_DYNAMIC_DISPATCH(GatherHere)(layout, areas, x + 3 * layout.first_vertex, field, slopes, push);
}

std::array<double, 2> SumBySide(const std::vector<double>& on_left, const double* a, const double* b) {
  return HWY_DYNAMIC_DISPATCH(SumBySideHere)(on_left, a, b);
}

void AddBySide(const std::vector<double>& on_left, double right, double left, const double* values, double* to) {
  HWY_DYNAMIC_DISPATCH(AddBySideHere)(on_left, right, left, values, to);
}

void SetBySide(const std::vector<double>& on_left, double right, double left, const double* values, double* to) {
  HWY_DYNAMIC_DISPATCH(SetBySideHere)(on_left, right, left, values, to);
}

}  // namespace phrenic
#endif  // HWY_ONCE
