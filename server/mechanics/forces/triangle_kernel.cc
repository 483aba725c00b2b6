#include "server/mechanics/forces/triangle_kernel.h"

#include <cstddef>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/triangle_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr int kWidth = static_cast<int>(points::kLanes);
static_assert(kBatch % kWidth == 0);

// The forces of one batch on the corners a, b and c [N].
struct Forces {
  points::Rows a[kBatch / kWidth], b[kBatch / kWidth], c[kBatch / kWidth];
  HWY_ALIGN double area[kBatch];  // current area over rest area
};

HWY_INLINE Vectors Scaled(const Vector& s, const Vectors& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE Vectors Added(const Vectors& a, const Vectors& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector Dot(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vectors Cross(const Vectors& a, const Vectors& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE Vectors Between(const Vectors& from, const Vectors& to) {
  return {hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
}

// Scatters the forces triangle by triangle, so that the order of additions to a vertex is the same for all targets.
HWY_INLINE void Scatter(const TriangleBatch& batch, const Forces& forces, double* f) {
#pragma GCC unroll 8
  for (int i = 0; i < kBatch; ++i) {
    points::AddRow(forces.a[i / kWidth], i % kWidth, f + batch.a[i]);
    points::AddRow(forces.b[i / kWidth], i % kWidth, f + batch.b[i]);
    points::AddRow(forces.c[i / kWidth], i % kWidth, f + batch.c[i]);
  }
}

// Computes the forces of kWidth triangles from lane `first` on. Returns true if one of them has zero area.
HWY_INLINE bool ComputeForces(const TriangleBatch& batch, double mu, double lambda, int first, const double* x,
                              Forces& forces) {
  const Tag d;
  const Vector zero = hn::Zero(d), two = hn::Set(d, 2), twice = hn::Set(d, 2 * mu);
  const Vectors a = points::Transposed<true>(x, batch.a + first);
  const Vectors b = Between(a, points::Transposed<true>(x, batch.b + first));
  const Vectors c = Between(a, points::Transposed<true>(x, batch.c + first));
  const Vector b1 = hn::Load(d, batch.b1 + first), b2 = hn::Load(d, batch.b2 + first);
  const Vector c1 = hn::Load(d, batch.c1 + first), c2 = hn::Load(d, batch.c2 + first);
  const Vectors f1 = Added(Scaled(b1, b), Scaled(c1, c)), f2 = Added(Scaled(b2, b), Scaled(c2, c));
  const Vectors cross = Cross(f1, f2);
  const Vector area = hn::Sqrt(Dot(cross, cross));
  const auto flat = hn::Eq(area, zero);
  const Vector divisor = hn::IfThenElse(flat, two, area);  // any non-zero number in flat lanes
  const Vector trace = hn::Sqrt(hn::Add(hn::Add(Dot(f1, f1), Dot(f2, f2)), hn::Mul(two, divisor)));
  const Vectors normal = Scaled(hn::Div(hn::Set(d, 1), divisor), cross);
  const Vector factor =
      hn::Div(hn::Sub(hn::Mul(hn::Set(d, lambda), hn::Sub(trace, two)), twice), trace);  // of F + cofactor(F)
  const Vector volume = hn::IfThenZeroElse(flat, hn::Neg(hn::Load(d, batch.volume + first)));
  const Vectors p1 = Added(Scaled(twice, f1), Scaled(factor, Added(f1, Cross(f2, normal))));
  const Vectors p2 = Added(Scaled(twice, f2), Scaled(factor, Added(f2, Cross(normal, f1))));
  const Vectors on_b = Scaled(volume, Added(Scaled(b1, p1), Scaled(b2, p2)));
  const Vectors on_c = Scaled(volume, Added(Scaled(c1, p1), Scaled(c2, p2)));
  forces.a[first / kWidth] = points::ToRows(Scaled(hn::Set(d, -1), Added(on_b, on_c)));
  forces.b[first / kWidth] = points::ToRows(on_b);
  forces.c[first / kWidth] = points::ToRows(on_c);
  hn::Store(area, d, forces.area + first);
  return !hn::AllFalse(d, flat);
}

// Appends the indices of the batch's triangles with zero area.
void NoteFlat(const TriangleBatch& batch, const Forces& forces, size_t number, std::vector<int>& flat) {
  for (size_t i = 0; i < kBatch; ++i) {
    if (forces.area[i] == 0 && batch.volume[i] > 0) flat.push_back(static_cast<int>(number * kBatch + i));
  }
}

void AddAllTriangles(const std::vector<TriangleBatch>& batches, double mu, double lambda, const double* x, double* f,
                     std::vector<int>& flat) {
  Forces forces;
  for (size_t n = 0; n < batches.size(); ++n) {
    bool any = false;
    for (int first = 0; first < kBatch; first += kWidth) {
      any = ComputeForces(batches[n], mu, lambda, first, x, forces) || any;
    }
    if (any) NoteFlat(batches[n], forces, n, flat);
    Scatter(batches[n], forces, f);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddAllTriangles);

void AddTriangles(const std::vector<TriangleBatch>& batches, double mu, double lambda, const double* x, double* f,
                  std::vector<int>& flat) {
  HWY_DYNAMIC_DISPATCH(AddAllTriangles)(batches, mu, lambda, x, f, flat);
}

}  // namespace phrenic
#endif  // HWY_ONCE
