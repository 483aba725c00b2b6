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

 private:
  Tag d_;
  hn::Vec<Tag> x_, y_, z_, sum_[kParts];
};

template <bool kVelocities>
void Apply(std::span<const SkinWeight> weights, const DriverState& drivers, const double* rest, double* x, double* v) {
  for (auto weight = weights.begin(); weight != weights.end();) {
    const int vertex = weight->vertex;
    const std::ptrdiff_t first = 3 * static_cast<std::ptrdiff_t>(vertex);
    Posed<kVelocities> posed(rest + first);
    double moved[3] = {}, velocity[3] = {};
    for (; weight != weights.end() && weight->vertex == vertex; ++weight) {
      if (weight->pose >= 0) {
        posed.Add(weight->weight, drivers.poses[static_cast<size_t>(weight->pose)]);
        continue;
      }
      const std::ptrdiff_t driver = 3 * static_cast<std::ptrdiff_t>(weight->simulated_vertex);
      for (int k = 0; k < 3; ++k) {
        moved[k] += weight->weight * (drivers.x[driver + k] - drivers.rest[driver + k]);
        if (kVelocities) velocity[k] += weight->weight * drivers.v[driver + k];
      }
    }
    HWY_ALIGN double given[kNumbers];
    posed.Store(given);
    for (int k = 0; k < 3; ++k) {
      x[first + k] = rest[first + k] + (given[k] + moved[k]);
      if (kVelocities) v[first + k] = given[kNumbers / 2 + k] + velocity[k];
    }
  }
}

void ApplyHere(std::span<const SkinWeight> weights, const DriverState& drivers, const double* rest, double* x,
               double* v) {
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

void ApplySkinWeights(std::span<const SkinWeight> weights, const DriverState& drivers, const double* rest, double* x,
                      double* v) {
  HWY_DYNAMIC_DISPATCH(ApplyHere)(weights, drivers, rest, x, v);
}

}  // namespace phrenic
#endif  // HWY_ONCE
