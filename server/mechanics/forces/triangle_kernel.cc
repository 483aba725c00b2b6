#include "server/mechanics/forces/triangle_kernel.h"

#include <algorithm>
#include <cstddef>

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/triangle_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, kBatch>;
using Vector = hn::Vec<Tag>;
constexpr size_t kWidth = hn::MaxLanes(Tag());
static_assert(kBatch % kWidth == 0);

// Batches that are gathered before the first is worked out: vectors are not to wait for what was just stored.
constexpr size_t kStage = 16;

// Of a batch the sides b - a and c - a [m], x, y and z; then the forces on b and c [N].
struct alignas(64) Sides {
  double b[3][kBatch], c[3][kBatch];
  double area[kBatch];  // over that at rest
};

struct Vectors {
  Vector x, y, z;
};

HWY_INLINE Vectors Load(const double (*from)[kBatch], size_t first) {
  const Tag d;
  return {hn::Load(d, from[0] + first), hn::Load(d, from[1] + first), hn::Load(d, from[2] + first)};
}
HWY_INLINE void Store(const Vectors& v, double (*to)[kBatch], size_t first) {
  const Tag d;
  hn::Store(v.x, d, to[0] + first), hn::Store(v.y, d, to[1] + first), hn::Store(v.z, d, to[2] + first);
}
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

void Gather(const TriangleBatch& batch, const double* x, Sides& sides) {
  for (int i = 0; i < kBatch; ++i) {
    const double *const a = x + batch.a[i], *const b = x + batch.b[i], *const c = x + batch.c[i];
    for (int k = 0; k < 3; ++k) sides.b[k][i] = b[k] - a[k], sides.c[k][i] = c[k] - a[k];
  }
}

void Scatter(const TriangleBatch& batch, const Sides& sides, double* f) {
  for (int i = 0; i < kBatch; ++i) {
    double *const a = f + batch.a[i], *const b = f + batch.b[i], *const c = f + batch.c[i];
    for (int k = 0; k < 3; ++k) {
      const double on_b = sides.b[k][i], on_c = sides.c[k][i];
      a[k] -= on_b + on_c;
      b[k] += on_b;
      c[k] += on_c;
    }
  }
}

// From sides to forces, kWidth triangles from lane `first` on; true where one of them is flat.
HWY_INLINE bool Pull(const TriangleBatch& batch, double mu, double lambda, size_t first, Sides& sides) {
  const Tag d;
  const Vector zero = hn::Zero(d), two = hn::Set(d, 2), twice = hn::Set(d, 2 * mu);
  const Vectors b = Load(sides.b, first), c = Load(sides.c, first);
  const Vector b1 = hn::Load(d, batch.b1 + first), b2 = hn::Load(d, batch.b2 + first);
  const Vector c1 = hn::Load(d, batch.c1 + first), c2 = hn::Load(d, batch.c2 + first);
  const Vectors f1 = Added(Scaled(b1, b), Scaled(c1, c)), f2 = Added(Scaled(b2, b), Scaled(c2, c));
  const Vectors cross = Cross(f1, f2);
  const Vector area = hn::Sqrt(Dot(cross, cross));
  const auto flat = hn::Eq(area, zero);
  const Vector divisor = hn::IfThenElse(flat, two, area);  // any number that is none of zero
  const Vector trace = hn::Sqrt(hn::Add(hn::Add(Dot(f1, f1), Dot(f2, f2)), hn::Mul(two, divisor)));
  const Vectors normal = Scaled(hn::Div(hn::Set(d, 1), divisor), cross);
  const Vector turned =
      hn::Div(hn::Sub(hn::Mul(hn::Set(d, lambda), hn::Sub(trace, two)), twice), trace);  // of R's two columns
  const Vector volume = hn::IfThenZeroElse(flat, hn::Neg(hn::Load(d, batch.volume + first)));
  const Vectors p1 = Added(Scaled(twice, f1), Scaled(turned, Added(f1, Cross(f2, normal))));
  const Vectors p2 = Added(Scaled(twice, f2), Scaled(turned, Added(f2, Cross(normal, f1))));
  Store(Scaled(volume, Added(Scaled(b1, p1), Scaled(b2, p2))), sides.b, first);
  Store(Scaled(volume, Added(Scaled(c1, p1), Scaled(c2, p2))), sides.c, first);
  hn::Store(area, d, sides.area + first);
  return !hn::AllFalse(d, flat);
}

void NoteFlat(const TriangleBatch& batch, const Sides& sides, size_t number, std::vector<int>& flat) {
  for (size_t i = 0; i < kBatch; ++i) {
    if (sides.area[i] == 0 && batch.volume[i] > 0) flat.push_back(static_cast<int>(number * kBatch + i));
  }
}

void AddAllTriangles(const std::vector<TriangleBatch>& batches, double mu, double lambda, const double* x, double* f,
                     std::vector<int>& flat) {
  Sides sides[kStage];
  const size_t count = batches.size();
  for (size_t start = 0; start < count; start += kStage) {
    const size_t stage = std::min(kStage, count - start);
    for (size_t s = 0; s < stage; ++s) Gather(batches[start + s], x, sides[s]);
    for (size_t s = 0; s < stage; ++s) {
      bool any = false;
      for (size_t first = 0; first < kBatch; first += kWidth) {
        any = Pull(batches[start + s], mu, lambda, first, sides[s]) || any;
      }
      if (any) NoteFlat(batches[start + s], sides[s], start + s, flat);
    }
    for (size_t s = 0; s < stage; ++s) Scatter(batches[start + s], sides[s], f);
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
