#include "server/mechanics/linalg/outer_products_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/linalg/outer_products_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using points::Tag, points::Vector, points::Vectors;
constexpr std::size_t kColumnLanes = points::kLanes;
constexpr std::size_t kColumnPacket = 8;  // columns whose sums stay apart, so that the order of additions is one

HWY_INLINE Vectors LoadColumns(const double* from) {
  Vectors v;
  hn::LoadInterleaved3(Tag(), from, v.x, v.y, v.z);
  return v;
}

HWY_INLINE Vector DotOf(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE void AddTo(double* sum, Vector value) {
  const Tag d;
  hn::StoreU(hn::Add(hn::LoadU(d, sum), value), d, sum);
}

// Adds the products of the columns from `i` on to the lanes from `lane` on of each sum.
HWY_INLINE void AddProducts(const WeightedTerms& terms, const double* start, const double* v, std::size_t i,
                            std::size_t lane, double* sums) {
  const Tag d;
  const Vectors from = LoadColumns(start + 3 * i), to = LoadColumns(v + 3 * i);
  const Vectors gain = {hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
  const Vector weight = hn::LoadU(d, terms.weights + i);
  double* sum = sums + lane;
  for (std::size_t a = 0; a < terms.g.size(); ++a) {
    const Vectors g = LoadColumns(terms.g[a] + 3 * i);
    AddTo(sum, DotOf(g, gain));
    sum += kColumnPacket;
    for (std::size_t b = 0; b <= a; ++b, sum += kColumnPacket) {
      AddTo(sum, hn::Mul(weight, DotOf(g, LoadColumns(terms.g[b] + 3 * i))));
    }
  }
}

// The columns that fill no packet.
void AddLastProducts(const WeightedTerms& terms, const double* start, const double* v, std::size_t first,
                     double* sums) {
  for (std::size_t i = first; i < terms.columns; ++i) {
    double* sum = sums + (i - first);
    const auto dot = [i](const double* p, const double* q) {
      return p[3 * i] * q[3 * i] + p[3 * i + 1] * q[3 * i + 1] + p[3 * i + 2] * q[3 * i + 2];
    };
    for (std::size_t a = 0; a < terms.g.size(); ++a) {
      const double* const g = terms.g[a];
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) *sum += g[c] * (v[c] - start[c]);
      sum += kColumnPacket;
      for (std::size_t b = 0; b <= a; ++b, sum += kColumnPacket) *sum += terms.weights[i] * dot(g, terms.g[b]);
    }
  }
}

void SumProductsHere(const WeightedTerms& terms, const double* start, const double* v, double* sums) {
  const std::size_t whole = terms.columns / kColumnPacket * kColumnPacket;
  for (std::size_t i = 0; i < whole; i += kColumnLanes) AddProducts(terms, start, v, i, i % kColumnPacket, sums);
  AddLastProducts(terms, start, v, whole, sums);
}

void TakeOffHere(const WeightedTerms& terms, const double* along, double dt, double* v, double* x) {
  const Tag d;
  const Vector step = hn::Set(d, dt);
  const std::size_t whole = terms.columns / kColumnPacket * kColumnPacket;
  const auto take = [&](double* from, const Vectors& less) HWY_ATTR {
    const Vectors v3 = LoadColumns(from);
    hn::StoreInterleaved3(hn::Sub(v3.x, less.x), hn::Sub(v3.y, less.y), hn::Sub(v3.z, less.z), d, from);
  };
  for (std::size_t i = 0; i < whole; i += kColumnLanes) {
    const Vector weight = hn::LoadU(d, terms.weights + i);
    Vectors less = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t k = 0; k < terms.g.size(); ++k) {
      const Vectors g = LoadColumns(terms.g[k] + 3 * i);
      const Vector factor = hn::Mul(weight, hn::Set(d, along[k]));
      less = {hn::Add(less.x, hn::Mul(factor, g.x)), hn::Add(less.y, hn::Mul(factor, g.y)),
              hn::Add(less.z, hn::Mul(factor, g.z))};
    }
    take(v + 3 * i, less);
    take(x + 3 * i, {hn::Mul(step, less.x), hn::Mul(step, less.y), hn::Mul(step, less.z)});
  }
  for (std::size_t c = 3 * whole; c < 3 * terms.columns; ++c) {
    double less = 0;
    for (std::size_t k = 0; k < terms.g.size(); ++k) less += terms.weights[c / 3] * along[k] * terms.g[k][c];
    v[c] -= less;
    x[c] -= dt * less;
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(SumProductsHere);
HWY_EXPORT(TakeOffHere);

void SumProducts(const WeightedTerms& terms, const double* start, const double* v, std::vector<double>& lanes,
                 double* along, double* gram) {
  const std::size_t count = terms.g.size();
  lanes.assign(8 * (count + count * (count + 1) / 2), 0);
  HWY_DYNAMIC_DISPATCH(SumProductsHere)(terms, start, v, lanes.data());
  const double* next = lanes.data();
  const auto sum = [&next] {
    double all = 0;
    for (int lane = 0; lane < 8; ++lane) all += *next++;
    return all;
  };
  for (std::size_t a = 0; a < count; ++a) {
    along[a] = sum();
    for (std::size_t b = 0; b <= a; ++b) gram[a * count + b] = sum();
  }
}

void TakeOffTerms(const WeightedTerms& terms, const double* along, double dt, double* v, double* x) {
  HWY_DYNAMIC_DISPATCH(TakeOffHere)(terms, along, dt, v, x);
}

}  // namespace phrenic
#endif  // HWY_ONCE
