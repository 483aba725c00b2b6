#include "server/mechanics/linalg/vertex_kernel.h"

#include <cmath>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/linalg/vertex_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using points::Tag, points::Vector;
constexpr Eigen::Index kLanes = points::kLanes;

// Repeats one number per vertex for each coordinate: the coordinates of kLanes vertices fill three vectors.
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

// A force repeated for each of kLanes vertices, whose coordinates fill three vectors.
struct Repeated {
  HWY_ALIGN double numbers[3 * kLanes];

  void Set(const Eigen::Vector3d& force) {
    for (Eigen::Index i = 0; i < kLanes; ++i) {
      for (Eigen::Index c = 0; c < 3; ++c) numbers[3 * i + c] = force[c];
    }
  }
  HWY_INLINE Vector At(int vector) const { return hn::Load(Tag(), numbers + vector * kLanes); }
};

// Loads of a number that is known at compile time.
template <bool kRubs, size_t kCount>
class Loads {
 public:
  explicit Loads(const VertexLoads& loads) : loads_(loads) {
    for (size_t l = 0; l < kCount; ++l) forces_[l].Set(loads.shared[l].force), weights_[l] = loads.shared[l].weight;
  }

  // Adds the loads on kLanes vertices to f; v are their velocities [m/s].
  HWY_INLINE void AddTo(const Spread& spread, Eigen::Index vertex, const Vector (&v)[3], Vector (&f)[3]) const {
    const Tag d;
    if constexpr (kRubs) {
      const Vector c = hn::LoadU(d, loads_.c + vertex);
      for (int i = 0; i < 3; ++i) f[i] = hn::Sub(f[i], hn::Mul(spread.Of(c, i), v[i]));
    }
#pragma GCC unroll 4
    for (size_t l = 0; l < kCount; ++l) {
      const Vector weight = hn::LoadU(d, weights_[l] + vertex);
      for (int i = 0; i < 3; ++i) f[i] = hn::Add(f[i], hn::Mul(spread.Of(weight, i), forces_[l].At(i)));
    }
  }
  // Returns a coordinate of the force on one vertex with its loads.
  double Sum(double f, Eigen::Index vertex, int i, double v) const {
    if constexpr (kRubs) f -= loads_.c[vertex] * v;
    for (size_t l = 0; l < kCount; ++l) f += weights_[l][vertex] * loads_.shared[l].force[i];
    return f;
  }

 private:
  const VertexLoads& loads_;
  Repeated forces_[kCount + 1];
  const double* weights_[kCount + 1];
};

// Calls Do::In(range, Loads<...>, ...) for the number of loads.
template <typename Do, bool kRubs, typename... Arguments>
HWY_INLINE void ByCount(const VertexRange& range, const VertexLoads& loads, Arguments... arguments) {
  static_assert(VertexLoads::kMost == 4);
  if (loads.count == 0) Do::In(range, Loads<kRubs, 0>(loads), arguments...);
  if (loads.count == 1) Do::In(range, Loads<kRubs, 1>(loads), arguments...);
  if (loads.count == 2) Do::In(range, Loads<kRubs, 2>(loads), arguments...);
  if (loads.count == 3) Do::In(range, Loads<kRubs, 3>(loads), arguments...);
  if (loads.count == 4) Do::In(range, Loads<kRubs, 4>(loads), arguments...);
}

template <typename Do, typename... Arguments>
HWY_INLINE void WithLoads(const VertexRange& range, const VertexLoads& loads, Arguments... arguments) {
  loads.c != nullptr ? ByCount<Do, true>(range, loads, arguments...) : ByCount<Do, false>(range, loads, arguments...);
}

// The bounds of vertices so far.
struct Reached {
  points::Largest furthest, fastest;

  HWY_INLINE void Note(Vector x, Vector v) { furthest.Note(x), fastest.Note(v); }
  StateBounds Whole() const { return {furthest.Whole(), fastest.Whole()}; }
};

void Note(double x, double v, StateBounds& bounds) {
  bounds.furthest = LargerMagnitude(bounds.furthest, std::abs(x));
  bounds.fastest = LargerMagnitude(bounds.fastest, std::abs(v));
}

HWY_INLINE void LoadThree(const double* from, Vector (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = hn::LoadU(Tag(), from + i * kLanes);
}

struct Adding {
  template <typename Loads>
  static HWY_INLINE void In(const VertexRange& range, const Loads& loads, const double* v, double* f) {
    const Spread spread;
    Eigen::Index vertex = range.first;
    for (; vertex + kLanes <= range.end; vertex += kLanes) {
      double* const to = f + 3 * (vertex - range.first);
      Vector sum[3], speed[3];
      LoadThree(to, sum), LoadThree(v + 3 * vertex, speed);
      loads.AddTo(spread, vertex, speed, sum);
      for (int i = 0; i < 3; ++i) hn::StoreU(sum[i], Tag(), to + i * kLanes);
    }
    for (; vertex < range.end; ++vertex) {
      for (int i = 0; i < 3; ++i) {
        double& to = f[3 * (vertex - range.first) + i];
        to = loads.Sum(to, vertex, i, v[3 * vertex + i]);
      }
    }
  }
};

void AddLoadsHere(const VertexRange& range, const VertexLoads& loads, const double* v, double* f) {
  WithLoads<Adding>(range, loads, v, f);
}

// Arrays of all vertices; f has the columns of the range.
struct Kick {
  const double* inverse_mass;
  double kick, drift;
  const double *f, *x, *v;
  double *x_next, *v_next;
  StateBounds* bounds;
};

struct Kicking {
  template <typename Loads>
  static HWY_INLINE void In(const VertexRange& range, const Loads& loads, const Kick& with) {
    const Spread spread;
    Reached reached;
    Eigen::Index vertex = range.first;
    for (; vertex + kLanes <= range.end; vertex += kLanes) Eight(spread, range.first, vertex, loads, with, reached);
    StateBounds& bounds = *with.bounds = reached.Whole();
    for (; vertex < range.end; ++vertex) {
      const double w = with.inverse_mass[vertex];
      for (Eigen::Index c = 0, i = 3 * vertex; c < 3; ++c, ++i) {
        const double f = loads.Sum(with.f[i - 3 * range.first], vertex, static_cast<int>(c), with.v[i]);
        with.v_next[i] = w > 0 ? with.v[i] + with.kick * w * f : with.v[i];
        with.x_next[i] = w > 0 ? with.x[i] + with.drift * with.v_next[i] : with.x[i];
        Note(with.x_next[i], with.v_next[i], bounds);
      }
    }
  }

  // Moves kLanes vertices.
  template <typename Loads>
  static HWY_INLINE void Eight(const Spread& spread, Eigen::Index first, Eigen::Index vertex, const Loads& loads,
                               const Kick& with, Reached& reached) {
    const Tag d;
    const auto kicks = hn::Set(d, with.kick), drifts = hn::Set(d, with.drift);
    const Vector inverse_mass = hn::LoadU(d, with.inverse_mass + vertex);
    Vector f[3], before[3];
    LoadThree(with.f + 3 * (vertex - first), f), LoadThree(with.v + 3 * vertex, before);
    loads.AddTo(spread, vertex, before, f);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Index place = 3 * vertex + i * kLanes;
      const Vector w = spread.Of(inverse_mass, i), at = hn::LoadU(d, with.x + place);
      const auto free = hn::Gt(w, hn::Zero(d));
      const auto now = hn::IfThenElse(free, hn::Add(before[i], hn::Mul(hn::Mul(kicks, w), f[i])), before[i]);
      const auto there = hn::IfThenElse(free, hn::Add(at, hn::Mul(drifts, now)), at);
      hn::StoreU(now, d, with.v_next + place);
      hn::StoreU(there, d, with.x_next + place);
      reached.Note(there, now);
    }
  }
};

StateBounds KickAndDriftHere(const VertexRange& range, const VertexLoads& loads, const double* inverse_mass,
                             double kick, double drift, const double* f, const double* x, const double* v,
                             double* x_next, double* v_next) {
  StateBounds bounds;
  WithLoads<Kicking>(range, loads, Kick{inverse_mass, kick, drift, f, x, v, x_next, v_next, &bounds});
  return bounds;
}

StateBounds BoundsHere(const double* x, const double* v, Eigen::Index count) {
  Reached reached;
  Eigen::Index i = 0;
  for (; i + kLanes <= count; i += kLanes) reached.Note(hn::LoadU(Tag(), x + i), hn::LoadU(Tag(), v + i));
  StateBounds bounds = reached.Whole();
  for (; i < count; ++i) Note(x[i], v[i], bounds);
  return bounds;
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(KickAndDriftHere);
HWY_EXPORT(AddLoadsHere);
HWY_EXPORT(BoundsHere);

void AddLoads(const VertexRange& range, const VertexLoads& loads, const ConstPoints& v, MutablePoints f) {
  HWY_DYNAMIC_DISPATCH(AddLoadsHere)(range, loads, v.data(), f.data());
}

StateBounds KickAndDrift(const VertexRange& range, const Eigen::VectorXd& w, double kick, double drift,
                         const ConstPoints& f, const VertexLoads& loads, const Points& x, const Points& v,
                         Points& x_next, Points& v_next) {
  return HWY_DYNAMIC_DISPATCH(KickAndDriftHere)(range, loads, w.data(), kick, drift, f.data(), x.data(), v.data(),
                                                x_next.data(), v_next.data());
}

StateBounds BoundsOf(const VertexRange& range, const Points& x, const Points& v) {
  const Eigen::Index first = 3 * range.first;
  return HWY_DYNAMIC_DISPATCH(BoundsHere)(x.data() + first, v.data() + first, 3 * range.end - first);
}

}  // namespace phrenic
#endif  // HWY_ONCE
