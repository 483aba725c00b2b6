#include "server/mechanics/skinning/skin_kernel.h"

#include <Eigen/Geometry>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/skinning/skin_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Numbers per vertex: displacement (x, y, z, 0) and velocity (x, y, z, 0).
constexpr int kNumbers = 8;

// The weighted sum over a vertex's poses of displacement and velocity, or of displacement only.
template <bool kVelocities>
class Posed {
  using Tag = hn::CappedTag<double, kVelocities ? kNumbers : kNumbers / 2>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int kParts = (kVelocities ? kNumbers : kNumbers / 2) / kLanes;

 public:
  HWY_INLINE explicit Posed(const double* rest)
      : x_(hn::Set(d_, rest[0])), y_(hn::Set(d_, rest[1])), z_(hn::Set(d_, rest[2])) {
    for (auto& part : sum_) part = hn::Zero(d_);
  }
  HWY_INLINE void Add(double weight, const PoseMatrices& pose) {
    const auto w = hn::Set(d_, weight);
    for (int p = 0; p < kParts; ++p) {
      const auto column = [&](int k) { return hn::Load(d_, pose.column[k] + p * kLanes); };
      const auto xy = hn::Add(hn::Mul(column(0), x_), hn::Mul(column(1), y_));
      const auto given = hn::Add(hn::Add(xy, hn::Mul(column(2), z_)), column(3));
      sum_[p] = hn::Add(sum_[p], hn::Mul(w, given));
    }
  }
  HWY_INLINE void Store(double* numbers) const {
    for (int p = 0; p < kParts; ++p) hn::Store(sum_[p], d_, numbers + p * kLanes);
  }
  HWY_INLINE hn::Vec<Tag> sum() const { return sum_[0]; }

 private:
  Tag d_;
  hn::Vec<Tag> x_, y_, z_, sum_[kParts];
};

// The weighted sum over simulated vertices of their displacement.
class Carried {
  using Tag = hn::CappedTag<double, 4>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int kParts = 4 / kLanes;

 public:
  HWY_INLINE Carried() {
    for (auto& part : sum_) part = hn::Zero(d_);
  }
  HWY_INLINE void Add(double weight, const Displacement& displacement) {
    const auto w = hn::Set(d_, weight);
    for (int p = 0; p < kParts; ++p) {
      sum_[p] = hn::Add(sum_[p], hn::Mul(w, hn::Load(d_, displacement.by + p * kLanes)));
    }
  }
  HWY_INLINE void Store(double* numbers) const {
    for (int p = 0; p < kParts; ++p) hn::Store(sum_[p], d_, numbers + p * kLanes);
  }
  HWY_INLINE hn::Vec<Tag> sum() const { return sum_[0]; }

 private:
  Tag d_;
  hn::Vec<Tag> sum_[kParts];
};

// Sets x = rest + displacement of a vertex; with kVelocities v too.
template <bool kVelocities>
HWY_INLINE void Put(const Posed<kVelocities>& posed, const Carried& carried, const double* velocity, const double* rest,
                    double* x, double* v) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (!kVelocities) {
    const hn::FixedTag<double, 4> four;
    const auto three = hn::FirstN(four, 3);
    const auto moved = hn::Add(posed.sum(), carried.sum());
    hn::BlendedStore(hn::Add(hn::MaskedLoad(three, four, rest), moved), three, four, x);
    return;
  }
#endif
  HWY_ALIGN double given[kNumbers], moved[4];
  posed.Store(given);
  carried.Store(moved);
  for (int k = 0; k < 3; ++k) {
    x[k] = rest[k] + (given[k] + moved[k]);
    if (kVelocities) v[k] = given[kNumbers / 2 + k] + velocity[k];
  }
}

template <bool kVelocities>
void Apply(const SkinWeights& of, const DriverState& drivers, const double* rest, double* x, double* v) {
  const int* driver = of.drivers.data();
  const double* weight = of.weights.data();
  for (const SkinWeights::Row& row : of.rows) {
    const std::ptrdiff_t first = 3 * static_cast<std::ptrdiff_t>(row.vertex);
    Posed<kVelocities> posed(rest + first);
    Carried carried;
    double velocity[3] = {};
    for (const int* const end = driver + row.poses; driver < end; ++driver, ++weight) {
      posed.Add(*weight, drivers.poses[static_cast<size_t>(*driver)]);
    }
    for (const int* const end = driver + row.simulated; driver < end; ++driver, ++weight) {
      carried.Add(*weight, drivers.displacements[*driver]);
      if constexpr (!kVelocities) continue;
      const std::ptrdiff_t at = 3 * static_cast<std::ptrdiff_t>(*driver);
      for (int k = 0; k < 3; ++k) velocity[k] += *weight * drivers.v[at + k];
    }
    Put<kVelocities>(posed, carried, velocity, rest + first, x + first, kVelocities ? v + first : nullptr);
  }
}

void ApplyHere(const SkinWeights& weights, const DriverState& drivers, const double* rest, double* x, double* v) {
  if (v == nullptr) {
    Apply<false>(weights, drivers, rest, x, v);
  } else {
    Apply<true>(weights, drivers, rest, x, v);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(ApplyHere);

void ApplySkinWeights(const SkinWeights& weights, const DriverState& drivers, const double* rest, double* x,
                      double* v) {
  HWY_DYNAMIC_DISPATCH(ApplyHere)(weights, drivers, rest, x, v);
}

}  // namespace phrenic
#endif  // HWY_ONCE
