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

// The sums of the columns in packets, in the order of SumProducts, of one term or two: all stays in registers.
template <std::size_t kTerms>
HWY_INLINE void SumPackets(const WeightedTerms& terms, const double* start, const double* v, std::size_t columns,
                           double* sums) {
  const Tag d;
  constexpr std::size_t kParts = kColumnPacket / kColumnLanes, kSums = kTerms * (kTerms + 3) / 2;
  Vector all[kSums][kParts];
  for (auto& sum : all) {
    for (Vector& part : sum) part = hn::Zero(d);
  }
  const double* const first = terms.g[0];
  const double* const last = terms.g[kTerms - 1];
  for (std::size_t i = 0; i < columns; i += kColumnPacket) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t column = i + part * kColumnLanes;
      const Vectors from = LoadColumns(start + 3 * column), to = LoadColumns(v + 3 * column);
      const Vectors gain = {hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
      const Vector weight = hn::LoadU(d, terms.weights + column);
      const Vectors a = LoadColumns(first + 3 * column);
      all[0][part] = hn::Add(all[0][part], DotOf(a, gain));
      all[1][part] = hn::Add(all[1][part], hn::Mul(weight, DotOf(a, a)));
      if constexpr (kTerms > 1) {
        const Vectors b = LoadColumns(last + 3 * column);
        all[2][part] = hn::Add(all[2][part], DotOf(b, gain));
        all[3][part] = hn::Add(all[3][part], hn::Mul(weight, DotOf(b, a)));
        all[4][part] = hn::Add(all[4][part], hn::Mul(weight, DotOf(b, b)));
      }
    }
  }
  for (const auto& sum : all) {
    for (const Vector& part : sum) hn::StoreU(part, d, sums), sums += kColumnLanes;
  }
}

// The same for any number of terms.
HWY_INLINE void SumPacketsOfMany(const WeightedTerms& terms, const double* start, const double* v, std::size_t columns,
                                 double* sums) {
  const Tag d;
  for (std::size_t i = 0; i < columns; i += kColumnLanes) {
    const Vectors from = LoadColumns(start + 3 * i), to = LoadColumns(v + 3 * i);
    const Vectors gain = {hn::Sub(to.x, from.x), hn::Sub(to.y, from.y), hn::Sub(to.z, from.z)};
    const Vector weight = hn::LoadU(d, terms.weights + i);
    double* sum = sums + i % kColumnPacket;
    const auto add = [&](Vector value) HWY_ATTR {
      hn::StoreU(hn::Add(hn::LoadU(d, sum), value), d, sum);
      sum += kColumnPacket;
    };
    for (std::size_t a = 0; a < terms.g.size(); ++a) {
      const Vectors g = LoadColumns(terms.g[a] + 3 * i);
      add(DotOf(g, gain));
      for (std::size_t b = 0; b <= a; ++b) add(hn::Mul(weight, DotOf(g, LoadColumns(terms.g[b] + 3 * i))));
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
  switch (terms.g.size()) {
    case 1:
      SumPackets<1>(terms, start, v, whole, sums);
      break;
    case 2:
      SumPackets<2>(terms, start, v, whole, sums);
      break;
    default:
      SumPacketsOfMany(terms, start, v, whole, sums);
  }
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
