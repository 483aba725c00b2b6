#include "server/mechanics/forces/muscle_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/muscle_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/forces/spring_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Of one triangle per lane: a number, a vector.
template <typename Number>
using Lane = hn::Vec<slices::SliceTag<Number>>;
template <typename Number>
using Axes = slices::Coordinates<Number>;

template <typename Number>
HWY_INLINE Lane<Number> All(double value) {
  return hn::Set(slices::SliceTag<Number>(), static_cast<Number>(value));
}
template <typename Number>
HWY_INLINE Axes<Number> Minus(const Axes<Number>& a, const Axes<Number>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
// Returns s a + t b.
template <typename Number>
HWY_INLINE Axes<Number> Blend(const Lane<Number>& s, const Axes<Number>& a, const Lane<Number>& t,
                              const Axes<Number>& b) {
  return {hn::Add(hn::Mul(s, a.x), hn::Mul(t, b.x)), hn::Add(hn::Mul(s, a.y), hn::Mul(t, b.y)),
          hn::Add(hn::Mul(s, a.z), hn::Mul(t, b.z))};
}
template <typename Number>
HWY_INLINE Lane<Number> InnerProducts(const Axes<Number>& a, const Axes<Number>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// The gradients of the shape functions of b and c along one direction.
template <typename Number>
struct Slopes {
  Lane<Number> b, c;
};

template <typename Number>
struct Sides {
  Axes<Number> b, c;  // of b and c relative to a

  HWY_INLINE Axes<Number> Along(const Slopes<Number>& slopes) const { return Blend<Number>(slopes.b, b, slopes.c, c); }
};

template <typename Number>
HWY_INLINE Sides<Number> SidesOf(const MuscleBatch<Number>& batch, int lane, const Number* points) {
  // Nothing may be read after the last point of all, unless points are padded.
  constexpr GatherMode kMode = kPointStride<Number> == 4 ? GatherMode::kOneByOne : GatherMode::kAtEnd;
  const Axes<Number> a = slices::GatherColumn<kMode>(points, batch.a, lane);
  return {Minus<Number>(slices::GatherColumn<kMode>(points, batch.b, lane), a),
          Minus<Number>(slices::GatherColumn<kMode>(points, batch.c, lane), a)};
}

// One deformed direction F d: its length, the stretch.
template <typename Number>
struct Direction {
  Axes<Number> at;
  Lane<Number> stretch;

  HWY_INLINE explicit Direction(const Axes<Number>& deformed)
      : at(deformed), stretch(hn::Sqrt(hn::Add(InnerProducts<Number>(at, at), All<Number>(kLeastSquaredStretch)))) {}
};

template <typename Number>
HWY_INLINE Lane<Number> Linear(const LinearTension& law, Lane<Number> resting, Lane<Number> stretch) {
  const auto tension = hn::Add(resting, hn::Mul(All<Number>(law.stiffness), hn::Sub(stretch, All<Number>(1))));
  return hn::Max(tension, hn::Mul(tension, All<Number>(law.compressed)));  // the share is at most 1
}

template <typename Number>
HWY_INLINE Lane<Number> OfMuscle(const MuscleLaw& law, double active, Lane<Number> resting, Lane<Number> stretch) {
  const auto zero = All<Number>(0), one = All<Number>(1);
  const double scale = 1 / (law.optimal * law.width);
  const auto s = hn::Sub(hn::Mul(stretch, All<Number>(scale)), All<Number>(1 / law.width));
  const auto length = hn::Max(zero, hn::Sub(one, hn::Mul(s, s)));
  const double taut = 1 / (1 - law.slack);
  const auto q =
      hn::Min(one, hn::Max(zero, hn::Sub(hn::Mul(stretch, All<Number>(taut)), All<Number>(law.slack * taut))));
  const auto over = hn::Min(one, hn::Max(zero, hn::Sub(stretch, one)));
  const auto passive =
      hn::Mul(hn::Mul(All<Number>(law.passive), over), hn::Add(one, hn::Mul(All<Number>(law.growth), over)));
  return hn::Add(hn::Add(hn::Mul(All<Number>(active), length), hn::Mul(resting, hn::Mul(q, q))), passive);
}

template <bool kMuscle, bool kViscous, typename Number>
HWY_INLINE void SetForcesOf(const MuscleBatch<Number>& batch, int lane, const MuscleLaw& law, double active,
                            const MusclePoints<Number>& points, Number* corners) {
  constexpr int kLanes = kMuscleLanes<Number>;
  const slices::SliceTag<Number> d;
  const Slopes<Number> f = {hn::Load(d, batch.b_along + lane), hn::Load(d, batch.c_along + lane)};
  const Slopes<Number> c = {hn::Load(d, batch.b_across + lane), hn::Load(d, batch.c_across + lane)};
  const Sides<Number> sides = SidesOf(batch, lane, points.x);
  const Direction<Number> fibre(sides.Along(f)), cross(sides.Along(c));
  const LinearTension linear = law.LinearOf(batch.tissue);
  const auto resting = hn::Load(d, batch.along + lane);
  Lane<Number> along =
      kMuscle ? OfMuscle<Number>(law, active, resting, fibre.stretch) : Linear<Number>(linear, resting, fibre.stretch);
  Lane<Number> across = Linear<Number>(linear, hn::Load(d, batch.across + lane), cross.stretch);
  along = hn::Div(along, fibre.stretch), across = hn::Div(across, cross.stretch);
  if constexpr (kViscous) {
    const Sides<Number> rates = SidesOf(batch, lane, points.v);
    const auto viscosity = All<Number>(law.ViscosityOf(batch.tissue));
    const auto per_stretch = [&](const Direction<Number>& direction, const Slopes<Number>& slopes) HWY_ATTR {
      const auto rate = InnerProducts<Number>(direction.at, rates.Along(slopes));  // times the stretch
      return hn::Div(hn::Mul(viscosity, rate), hn::Mul(direction.stretch, direction.stretch));
    };
    along = hn::Add(along, per_stretch(fibre, f)), across = hn::Add(across, per_stretch(cross, c));
  }
  const auto area = hn::Neg(hn::Load(d, batch.area + lane));
  const auto shear =
      hn::Mul(area, hn::Mul(All<Number>(law.ShearOf(batch.tissue)), InnerProducts<Number>(fibre.at, cross.at)));
  const Axes<Number> p = Blend<Number>(hn::Mul(area, along), fibre.at, shear, cross.at);
  const Axes<Number> u = Blend<Number>(hn::Mul(area, across), cross.at, shear, fibre.at);
  const Axes<Number> on_b = Blend<Number>(f.b, p, c.b, u), on_c = Blend<Number>(f.c, p, c.c, u);
  const auto minus = All<Number>(-1);
  slices::ToSlots<Number>(Blend<Number>(minus, on_b, minus, on_c), lane, corners);
  slices::ToSlots<Number>(on_b, lane, corners + 4 * kLanes);
  slices::ToSlots<Number>(on_c, lane, corners + 8 * kLanes);
}

template <typename Number>
HWY_INLINE void SetForces(const MuscleLayout<Number>& layout, std::int64_t first, std::int64_t end,
                          const MuscleLaw& law, const double* active, const MusclePoints<Number>& points,
                          Number* corners) {
  for (std::int64_t n = first; n < end; ++n) {
    const MuscleBatch<Number>& batch = layout.batches[n];
    Number* const own = corners + n * kCornerNumbers<Number>;
    const bool muscle = batch.tissue == Tissue::kMuscle, viscous = law.ViscosityOf(batch.tissue) > 0;
    for (int lane = 0; lane < kMuscleLanes<Number>; lane += slices::kWidth<Number>) {
      if (muscle) {
        viscous ? SetForcesOf<true, true>(batch, lane, law, active[batch.bundle], points, own)
                : SetForcesOf<true, false>(batch, lane, law, active[batch.bundle], points, own);
      } else {
        viscous ? SetForcesOf<false, true>(batch, lane, law, 0, points, own)
                : SetForcesOf<false, false>(batch, lane, law, 0, points, own);
      }
    }
  }
}

void SetForcesInDouble(const MuscleLayout<double>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                       const double* active, const MusclePoints<double>& points, double* corners) {
  SetForces(layout, first, end, law, active, points, corners);
}

void SetForcesInSingle(const MuscleLayout<float>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                       const double* active, const MusclePoints<float>& points, float* corners) {
  SetForces(layout, first, end, law, active, points, corners);
}

// Writes the sums of the corner forces of a slice's rows, four numbers each.
template <typename Number>
HWY_INLINE void SumCorners(const std::int32_t* offset, int columns, const Number* corners, Number* sums) {
  for (int i = 0; i < 4 * kGatherRows; ++i) sums[i] = 0;
  for (int c = 0; c < columns; ++c, offset += kGatherRows) {
    for (int row = 0; row < kGatherRows; ++row) {
      for (int k = 0; k < 4; ++k) sums[4 * row + k] += corners[offset[row] + k];
    }
  }
}

#if HWY_TARGET != HWY_SCALAR
HWY_INLINE void SumCorners(const std::int32_t* offset, int columns, const float* corners, float* sums) {
  const hn::FixedTag<float, 4> four;
  auto s0 = hn::Zero(four), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  const auto corner = [&](int row) HWY_ATTR { return hn::Load(four, corners + offset[row]); };
  for (int c = 0; c < columns; ++c, offset += kGatherRows) {
    s0 = hn::Add(s0, corner(0)), s1 = hn::Add(s1, corner(1)), s2 = hn::Add(s2, corner(2));
    s3 = hn::Add(s3, corner(3)), s4 = hn::Add(s4, corner(4)), s5 = hn::Add(s5, corner(5));
    s6 = hn::Add(s6, corner(6)), s7 = hn::Add(s7, corner(7));
  }
  hn::Store(s0, four, sums), hn::Store(s1, four, sums + 4), hn::Store(s2, four, sums + 8);
  hn::Store(s3, four, sums + 12), hn::Store(s4, four, sums + 16), hn::Store(s5, four, sums + 20);
  hn::Store(s6, four, sums + 24), hn::Store(s7, four, sums + 28);
}
#endif

#if HWY_TARGET <= HWY_AVX3
// Adds the sums of a whole slice's rows, and their load, to the forces on its vertices. Eight numbers of 24 at a time.
HWY_INLINE void AddRows(const float* sums, const double* load, double* f) {
  const hn::FixedTag<float, 16> d;
  const hn::FixedTag<double, 8> eight;
  const hn::FixedTag<float, 8> half;
  HWY_ALIGN static constexpr std::int32_t kLow[16] = {0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 0, 0, 0, 0};
  HWY_ALIGN static constexpr std::int32_t kHigh[16] = {5, 6, 8, 9, 10, 12, 13, 14, 0, 0, 0, 0, 0, 1, 2, 4};
  const auto low = hn::TableLookupLanes(hn::Load(d, sums), hn::SetTableIndices(d, kLow));
  const auto high = hn::TableLookupLanes(hn::Load(d, sums + 16), hn::SetTableIndices(d, kHigh));
  const auto middle = hn::OddEvenBlocks(hn::UpperHalf(half, high), hn::UpperHalf(half, low));
  const auto add = [&](int i, auto numbers) HWY_ATTR {
    auto sum = hn::Add(hn::LoadU(eight, f + i), hn::PromoteTo(eight, numbers));
    if (load != nullptr) sum = hn::Add(sum, hn::LoadU(eight, load + i));
    hn::StoreU(sum, eight, f + i);
  };
  add(0, hn::LowerHalf(half, low)), add(8, middle), add(16, hn::LowerHalf(half, high));
}
#endif

template <typename Number>
HWY_INLINE void Gather(const CornerSlices& gather, std::int64_t first, std::int64_t end, const Number* corners,
                       const double* load, double* f) {
  HWY_ALIGN Number sums[4 * kGatherRows];
  for (std::int64_t s = first; s < end; ++s) {
    const std::int32_t* const offset = &gather.offset[gather.first[s]];
    SumCorners(offset, (gather.first[s + 1] - gather.first[s]) / kGatherRows, corners, sums);
    const std::int64_t vertex = s * kGatherRows;
    const int rows = static_cast<int>(std::min<std::int64_t>(kGatherRows, gather.vertices - vertex));
#if HWY_TARGET <= HWY_AVX3
    if constexpr (std::is_same_v<Number, float>) {
      if (rows == kGatherRows) {
        AddRows(sums, load == nullptr ? nullptr : load + 3 * vertex, f + 3 * vertex);
        continue;
      }
    }
#endif
    for (int row = 0; row < rows; ++row) {
      double* const to = f + 3 * (vertex + row);
      for (int k = 0; k < 3; ++k) to[k] += static_cast<double>(sums[4 * row + k]);
    }
    if (load == nullptr) continue;
    for (int i = 0; i < 3 * rows; ++i) f[3 * vertex + i] += load[3 * vertex + i];
  }
}

void GatherInDouble(const CornerSlices& gather, std::int64_t first, std::int64_t end, const double* corners,
                    const double* load, double* f) {
  Gather(gather, first, end, corners, load, f);
}

void GatherInSingle(const CornerSlices& gather, std::int64_t first, std::int64_t end, const float* corners,
                    const double* load, double* f) {
  Gather(gather, first, end, corners, load, f);
}

// Lanes are summed over the batches first and then one after another, so that their number does not matter.
template <typename Number>
HWY_INLINE double SumRates(const MuscleLayout<Number>& layout, int bundle, const MusclePoints<Number>& points) {
  constexpr int kLanes = kMuscleLanes<Number>;
  const slices::SliceTag<Number> d;
  HWY_ALIGN Number sums[kLanes] = {};
  for (int n = layout.first_of_bundle[bundle]; n < layout.first_of_bundle[bundle + 1]; ++n) {
    const MuscleBatch<Number>& batch = layout.batches[n];
    for (int lane = 0; lane < kLanes; lane += slices::kWidth<Number>) {
      const Slopes<Number> f = {hn::Load(d, batch.b_along + lane), hn::Load(d, batch.c_along + lane)};
      const Direction<Number> fibre(SidesOf(batch, lane, points.x).Along(f));
      const auto product = InnerProducts<Number>(fibre.at, SidesOf(batch, lane, points.v).Along(f));
      const auto rate = hn::Mul(hn::Load(d, batch.area + lane), hn::Div(product, fibre.stretch));
      hn::Store(hn::Add(hn::Load(d, sums + lane), rate), d, sums + lane);
    }
  }
  double sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += static_cast<double>(sums[lane]);
  return sum;
}

double SumRatesInDouble(const MuscleLayout<double>& layout, int bundle, const MusclePoints<double>& points) {
  return SumRates(layout, bundle, points);
}

double SumRatesInSingle(const MuscleLayout<float>& layout, int bundle, const MusclePoints<float>& points) {
  return SumRates(layout, bundle, points);
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(SetForcesInDouble);
HWY_EXPORT(SetForcesInSingle);
HWY_EXPORT(GatherInDouble);
HWY_EXPORT(GatherInSingle);
HWY_EXPORT(SumRatesInDouble);
HWY_EXPORT(SumRatesInSingle);

void SetCornerForces(const MuscleLayout<double>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                     const double* active, const MusclePoints<double>& points, double* corners) {
  HWY_DYNAMIC_DISPATCH(SetForcesInDouble)(layout, first, end, law, active, points, corners);
}

void SetCornerForces(const MuscleLayout<float>& layout, std::int64_t first, std::int64_t end, const MuscleLaw& law,
                     const double* active, const MusclePoints<float>& points, float* corners) {
  HWY_DYNAMIC_DISPATCH(SetForcesInSingle)(layout, first, end, law, active, points, corners);
}

void GatherCorners(const CornerSlices& gather, std::int64_t first, std::int64_t end, const double* corners,
                   const double* load, double* f) {
  HWY_DYNAMIC_DISPATCH(GatherInDouble)(gather, first, end, corners, load, f);
}

void GatherCorners(const CornerSlices& gather, std::int64_t first, std::int64_t end, const float* corners,
                   const double* load, double* f) {
  HWY_DYNAMIC_DISPATCH(GatherInSingle)(gather, first, end, corners, load, f);
}

double SumStretchRates(const MuscleLayout<double>& layout, int bundle, const MusclePoints<double>& points) {
  return HWY_DYNAMIC_DISPATCH(SumRatesInDouble)(layout, bundle, points);
}

double SumStretchRates(const MuscleLayout<float>& layout, int bundle, const MusclePoints<float>& points) {
  return HWY_DYNAMIC_DISPATCH(SumRatesInSingle)(layout, bundle, points);
}

}  // namespace phrenic
#endif  // HWY_ONCE
