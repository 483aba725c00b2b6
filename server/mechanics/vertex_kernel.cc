#include "server/mechanics/vertex_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/vertex_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Tag>;
constexpr Eigen::Index kLanes = hn::MaxLanes(Tag());

// Of kLanes vertices, whose coordinates fill three vectors: a number a vertex, as often as it has coordinates in vector
// 0, 1, 2.
struct Spread {
  using Indices = decltype(hn::SetTableIndices(Tag(), static_cast<const std::int64_t*>(nullptr)));

  Spread() : indices{At(0), At(1), At(2)} {}
  static Indices At(std::int64_t vector) {
    std::int64_t vertex[kLanes];
    for (std::int64_t lane = 0; lane < kLanes; ++lane) vertex[lane] = (vector * kLanes + lane) / 3;
    return hn::SetTableIndices(Tag(), vertex);
  }
  HWY_INLINE Vector Of(Vector numbers, int vector) const { return hn::TableLookupLanes(numbers, indices[vector]); }

  Indices indices[3];
};

// Each vector of the coordinates is handed to `whole` with its numbers of the vertices and which of three it is, and
// what is left over coordinate by coordinate to `single`.
template <typename Whole, typename Single>
HWY_INLINE void ForEach(const VertexRange& range, const double* numbers, const Whole& whole, const Single& single) {
  const Tag d;
  const Spread spread;
  Eigen::Index vertex = range.first;
  for (; vertex + kLanes <= range.end; vertex += kLanes) {
    const auto of_vertices = hn::LoadU(d, numbers + vertex);
    for (int i = 0; i < 3; ++i) whole(3 * vertex + i * kLanes, spread.Of(of_vertices, i), i);
  }
  for (; vertex < range.end; ++vertex) {
    for (int i = 0; i < 3; ++i) single(3 * vertex + i, numbers[vertex]);
  }
}

void KickAndDriftHere(const VertexRange& range, const double* inverse_mass, double kick, double drift, const double* f,
                      const double* x, const double* v, double* x_next, double* v_next) {
  const Tag d;
  const Eigen::Index own = 3 * range.first;
  const auto kicks = hn::Set(d, kick), drifts = hn::Set(d, drift), zero = hn::Zero(d);
  const auto whole = [&](Eigen::Index i, Vector w, int) {
    const auto free = hn::Gt(w, zero);
    const auto before = hn::LoadU(d, v + i), at = hn::LoadU(d, x + i);
    const auto force = hn::LoadU(d, f + i - own);
    const auto now = hn::IfThenElse(free, hn::Add(before, hn::Mul(hn::Mul(kicks, w), force)), before);
    hn::StoreU(now, d, v_next + i);
    hn::StoreU(hn::IfThenElse(free, hn::Add(at, hn::Mul(drifts, now)), at), d, x_next + i);
  };
  const auto single = [&](Eigen::Index i, double w) {
    v_next[i] = w > 0 ? v[i] + kick * w * f[i - own] : v[i];
    x_next[i] = w > 0 ? x[i] + drift * v_next[i] : x[i];
  };
  ForEach(range, inverse_mass, whole, single);
}

// A force as often as vertices' coordinates fill three vectors.
struct Repeated {
  HWY_ALIGN double numbers[3 * kLanes];

  void Set(const Eigen::Vector3d& force) {
    for (Eigen::Index i = 0; i < 3 * kLanes; ++i) numbers[i] = force[i % 3];
  }
  HWY_INLINE Vector At(int vector) const { return hn::Load(Tag(), numbers + vector * kLanes); }
};

template <bool kRubs>
HWY_INLINE void AddLoadsTo(const VertexRange& range, const double* c, const double* v, const SharedLoad* loads,
                           size_t count, double* f) {
  const Tag d;
  const Spread spread;
  Repeated forces[kMostLoads];
  for (size_t l = 0; l < count; ++l) forces[l].Set(loads[l].force);
  Eigen::Index vertex = range.first;
  for (; vertex + kLanes <= range.end; vertex += kLanes) {
    double* const to = f + 3 * (vertex - range.first);
    Vector sum[3];
    for (int i = 0; i < 3; ++i) sum[i] = hn::LoadU(d, to + i * kLanes);
    if constexpr (kRubs) {
      const Vector of = hn::LoadU(d, c + vertex);
      for (int i = 0; i < 3; ++i) {
        sum[i] = hn::Sub(sum[i], hn::Mul(spread.Of(of, i), hn::LoadU(d, v + 3 * vertex + i * kLanes)));
      }
    }
    for (size_t l = 0; l < count; ++l) {
      const Vector of = hn::LoadU(d, loads[l].share + vertex);
      for (int i = 0; i < 3; ++i) sum[i] = hn::Add(sum[i], hn::Mul(spread.Of(of, i), forces[l].At(i)));
    }
    for (int i = 0; i < 3; ++i) hn::StoreU(sum[i], d, to + i * kLanes);
  }
  for (; vertex < range.end; ++vertex) {
    for (int i = 0; i < 3; ++i) {
      double& to = f[3 * (vertex - range.first) + i];
      if constexpr (kRubs) to -= c[vertex] * v[3 * vertex + i];
      for (size_t l = 0; l < count; ++l) to += loads[l].share[vertex] * loads[l].force[i];
    }
  }
}

void AddLoadsHere(const VertexRange& range, const double* c, const double* v, const SharedLoad* loads, size_t count,
                  double* f) {
  c != nullptr ? AddLoadsTo<true>(range, c, v, loads, count, f) : AddLoadsTo<false>(range, c, v, loads, count, f);
}

// Numbers are taken in groups of this many, one of each for a running result: whatever the vectors' length, and so many
// that none waits for the one before.
constexpr Eigen::Index kGroup = 32, kGroupVectors = kGroup / kLanes;

// The running results folded into one by halves, first with sixteenth, and so on: in the same order whatever the
// vectors' length.
template <typename D, typename V, typename Join>
HWY_INLINE hn::TFromD<D> Fold(D d, V (&results)[kGroupVectors], const Join& join) {
  for (Eigen::Index half = kGroupVectors / 2; half > 0; half /= 2) {
    for (Eigen::Index k = 0; k < half; ++k) results[k] = join(results[k], results[k + half]);
  }
  HWY_ALIGN hn::TFromD<D> all[kLanes];
  hn::Store(results[0], d, all);
  for (Eigen::Index half = kLanes / 2; half > 0; half /= 2) {
    for (Eigen::Index k = 0; k < half; ++k) all[k] = join(all[k], all[k + half]);
  }
  return all[0];
}

// Larger and sum, of vectors and of numbers.
struct Larger {
  template <typename V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Max(a, b);
  }
  std::int64_t operator()(std::int64_t a, std::int64_t b) const { return std::max(a, b); }
};
struct Plus {
  template <typename V>
  HWY_INLINE V operator()(V a, V b) const {
    return hn::Add(a, b);
  }
  double operator()(double a, double b) const { return a + b; }
};

// As whole numbers: without their signs numbers are in the order of their bits, infinity above all, and what is no
// number above that.
StateReach ReachHere(const double* x, const double* v, Eigen::Index count) {
  const Tag d;
  const hn::RebindToSigned<Tag> bits;
  const auto magnitude = hn::Set(bits, std::numeric_limits<std::int64_t>::max());
  hn::Vec<decltype(bits)> most[kGroupVectors];
  Vector squares[kGroupVectors];
  for (Eigen::Index k = 0; k < kGroupVectors; ++k) most[k] = hn::Zero(bits), squares[k] = hn::Zero(d);
  Eigen::Index i = 0;
  for (; i + kGroup <= count; i += kGroup) {
    for (Eigen::Index k = 0; k < kGroupVectors; ++k) {
      const auto place = hn::BitCast(bits, hn::LoadU(d, x + i + k * kLanes));
      const auto velocity = hn::LoadU(d, v + i + k * kLanes);
      most[k] = hn::Max(most[k], hn::And(place, magnitude));
      squares[k] = hn::Add(squares[k], hn::Mul(velocity, velocity));
    }
  }
  std::int64_t furthest = Fold(bits, most, Larger());
  double sum = Fold(d, squares, Plus());
  for (; i < count; ++i) {
    furthest = std::max(furthest, std::bit_cast<std::int64_t>(std::abs(x[i])));
    sum += v[i] * v[i];
  }
  return {std::bit_cast<double>(furthest), sum};
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(KickAndDriftHere);
HWY_EXPORT(AddLoadsHere);
HWY_EXPORT(ReachHere);

void KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift, const ConstPoints& f,
                  const Points& x, const Points& v, Points& x_next, Points& v_next) {
  HWY_DYNAMIC_DISPATCH(KickAndDriftHere)
  (range, w.data(), kick, drift, f.data(), x.data(), v.data(), x_next.data(), v_next.data());
}

void AddLoads(const VertexRange& range, const Eigen::VectorXd* c, const ConstPoints& v,
              std::span<const SharedLoad> loads, MutablePoints f) {
  HWY_DYNAMIC_DISPATCH(AddLoadsHere)
  (range, c == nullptr ? nullptr : c->data(), v.data(), loads.data(), loads.size(), f.data());
}

StateReach ReachOf(const VertexRange& range, const Points& x, const Points& v) {
  const Eigen::Index first = 3 * range.first;
  return HWY_DYNAMIC_DISPATCH(ReachHere)(x.data() + first, v.data() + first, 3 * range.end - first);
}

}  // namespace phrenic
#endif  // HWY_ONCE
