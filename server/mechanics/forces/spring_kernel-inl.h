// Loads of points and stores of sums, a vector of a slice's rows at a time (spring_kernel.h). To be included by a file
// that Google Highway compiles once for each instruction set, after <hwy/highway.h>.
#if defined(PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_INL_H_
#undef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_INL_H_
#else
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_INL_H_
#endif

#include <hwy/highway.h>

#include "server/mechanics/forces/spring_kernel.h"
#include "server/mechanics/linalg/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace slices {

namespace hn = hwy::HWY_NAMESPACE;

// A SIMD vector has as many lanes as a slice has rows, or a half, a quarter or fewer.
template <typename Number>
using SliceTag = hn::CappedTag<Number, kSliceRows<Number>>;
template <typename Number>
constexpr int kWidth = static_cast<int>(hn::MaxLanes(SliceTag<Number>()));

template <typename Number>
struct Coordinates {
  hn::Vec<SliceTag<Number>> x, y, z;
};

#if HWY_TARGET <= HWY_AVX3
// Gathers four pairs of points with one load each.
HWY_INLINE Coordinates<double> GatherPairs(const double* x, const std::int32_t* offset) {
  using V = hn::Vec<SliceTag<double>>;
  const SliceTag<double> d;
  const V a = hn::LoadU(d, x + offset[0]), b = hn::LoadU(d, x + offset[1]);
  const V c = hn::LoadU(d, x + offset[2]), e = hn::LoadU(d, x + offset[3]);
  const auto xy_ab = __builtin_shufflevector(a.raw, b.raw, 0, 8, 3, 11, 1, 9, 4, 12);
  const auto xy_ce = __builtin_shufflevector(c.raw, e.raw, 0, 8, 3, 11, 1, 9, 4, 12);
  const auto z_ab = __builtin_shufflevector(a.raw, b.raw, 2, 10, 5, 13, 2, 10, 5, 13);
  const auto z_ce = __builtin_shufflevector(c.raw, e.raw, 2, 10, 5, 13, 2, 10, 5, 13);
  return {V{__builtin_shufflevector(xy_ab, xy_ce, 0, 1, 8, 9, 2, 3, 10, 11)},
          V{__builtin_shufflevector(xy_ab, xy_ce, 4, 5, 12, 13, 6, 7, 14, 15)},
          V{__builtin_shufflevector(z_ab, z_ce, 0, 1, 8, 9, 2, 3, 10, 11)}};
}
#endif

template <GatherMode kMode>
HWY_INLINE Coordinates<double> Gather(const double* x, const std::int32_t* offset) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (kMode == GatherMode::kInPairs) return GatherPairs(x, offset);
#endif
  const points::Vectors gathered = points::Transposed<kMode == GatherMode::kAtEnd>(x, offset);
  return {gathered.x, gathered.y, gathered.z};
}

// Returns points i, i + 4, ..., as many as fit into a vector.
template <GatherMode kMode>
HWY_INLINE hn::Vec<SliceTag<float>> EveryFourth(const float* x, const std::int32_t* offset, int i) {
  const SliceTag<float> d;
#if HWY_TARGET == HWY_SCALAR
  return hn::Load(d, x + offset[i]);
#elif HWY_TARGET <= HWY_AVX3
  const hn::FixedTag<float, 8> half;
  if constexpr (kMode == GatherMode::kInPairs) {
    return hn::Combine(d, hn::LoadU(half, x + offset[i + 4]), hn::LoadU(half, x + offset[i]));
  }
  const hn::FixedTag<float, 4> one;
  const auto low = hn::Combine(half, hn::Load(one, x + offset[i + 4]), hn::Load(one, x + offset[i]));
  const auto high = hn::Combine(half, hn::Load(one, x + offset[i + 12]), hn::Load(one, x + offset[i + 8]));
  return hn::Combine(d, high, low);
#elif HWY_TARGET == HWY_AVX2
  if constexpr (kMode == GatherMode::kInPairs) return hn::LoadU(d, x + offset[i]);
  const hn::FixedTag<float, 4> one;
  return hn::Combine(d, hn::Load(one, x + offset[i + 4]), hn::Load(one, x + offset[i]));
#else
  return hn::Load(d, x + offset[i]);
#endif
}

template <GatherMode kMode>
HWY_INLINE Coordinates<float> Gather(const float* x, const std::int32_t* offset) {
  const SliceTag<float> d;
#if HWY_TARGET == HWY_SCALAR
  return {hn::Load(d, x + *offset), hn::Load(d, x + *offset + 1), hn::Load(d, x + *offset + 2)};
#else
  const hn::RepartitionToWide<SliceTag<float>> pairs;
  const auto a = EveryFourth<kMode>(x, offset, 0), b = EveryFourth<kMode>(x, offset, 1);
  const auto c = EveryFourth<kMode>(x, offset, 2), e = EveryFourth<kMode>(x, offset, 3);
  const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
  const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto z01 = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
  const auto z23 = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, xy01, xy23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, xy01, xy23)), hn::BitCast(d, hn::InterleaveLower(pairs, z01, z23))};
#endif
}

// Returns the points of a column from `row` on, one per lane.
template <GatherMode kMode, typename Number>
HWY_INLINE Coordinates<Number> GatherColumn(const Number* x, const std::int32_t* column, int row) {
  if constexpr (kMode == GatherMode::kInPairs) {
    return Gather<kMode>(x + PointOfPair(row) * kPointStride<Number>, column + PairOf(row));
  }
  return Gather<kMode>(x, column + row);
}

// Scatters the sums of a slice's rows from `row` on to their slots, as points (x, y, z, 0). `tile` is the slice's first
// slot.
template <typename Number>
HWY_INLINE void ToSlots(const Coordinates<Number>& sum, int row, Number* tile) {
  const SliceTag<Number> d;
  [[maybe_unused]] constexpr int kRows = kSliceRows<Number>;
  if constexpr (kWidth<Number> < 4) {
    HWY_ALIGN Number lanes[3][kWidth<Number>];
    hn::Store(sum.x, d, lanes[0]), hn::Store(sum.y, d, lanes[1]), hn::Store(sum.z, d, lanes[2]);
    for (int i = 0; i < kWidth<Number>; ++i) {
      for (int c = 0; c < 3; ++c) tile[SlotOf<Number>(0, row + i) + c] = lanes[c][i];
    }
  } else {
#if HWY_TARGET != HWY_SCALAR
    const auto xy = hn::InterleaveLower(d, sum.x, sum.y), xy_up = hn::InterleaveUpper(d, sum.x, sum.y);
    const auto z = hn::InterleaveLower(d, sum.z, hn::Zero(d)), z_up = hn::InterleaveUpper(d, sum.z, hn::Zero(d));
    if constexpr (std::is_same_v<Number, float>) {
      const hn::RepartitionToWide<SliceTag<float>> pairs;
      const auto store = [&](int i, auto points) { hn::Store(hn::BitCast(d, points), d, tile + i * kRows + row); };
      const auto a = hn::BitCast(pairs, xy), b = hn::BitCast(pairs, z);
      const auto a_up = hn::BitCast(pairs, xy_up), b_up = hn::BitCast(pairs, z_up);
      store(0, hn::InterleaveLower(pairs, a, b)), store(1, hn::InterleaveUpper(pairs, a, b));
      store(2, hn::InterleaveLower(pairs, a_up, b_up)), store(3, hn::InterleaveUpper(pairs, a_up, b_up));
    } else {
      const auto store = [&](int i, auto points) { hn::Store(points, d, tile + i * kRows + row); };
      store(0, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z), xy));
      store(1, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(z_up), xy_up));
      store(2, hn::OddEvenBlocks(z, hn::SwapAdjacentBlocks(xy)));
      store(3, hn::OddEvenBlocks(z_up, hn::SwapAdjacentBlocks(xy_up)));
    }
#endif
  }
}

}  // namespace slices
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_KERNEL_INL_H_
