#include "server/mechanics/forces/spring_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/spring_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/forces/spring_kernel-inl.h"
#include "server/mechanics/linalg/inverse_root-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using slices::Coordinates, slices::GatherColumn, slices::kWidth, slices::SliceTag, slices::ToSlots;

// Lower bound of l^2 [m^2]. Keeps 1/l, and the inverse of a product of three lengths, finite: l = 0 gives no force
// without a branch.
template <typename Number>
constexpr Number kShortestSquared = std::is_same_v<Number, float> ? 1e-36 : 1e-200;

// The rows of a slice from `row` on, one per lane.
template <typename Number>
struct Part {
  const SpringSlices<Number>& slices;
  std::int64_t slice;
  int row;
};

// The coefficients of one column for the part's rows: k [N/m] and k l0 [N].
template <typename Number>
struct Column {
  hn::Vec<SliceTag<Number>> stiffness, at_rest;
};

template <bool kUniform, typename Number>
HWY_INLINE Column<Number> ColumnAt(const Part<Number>& part, std::int64_t c) {
  const SliceTag<Number> d;
  const SpringSlices<Number>& slices = part.slices;
  const SpringSlice<Number>& slice = slices.slices[part.slice];
  const auto at_rest = hn::Load(d, slices.at_rest[c].row + part.row);
  if constexpr (kUniform) return {hn::Set(d, slice.common_stiffness), at_rest};
  return {hn::Load(d, slices.stiffness[c - slice.first_column + slice.first_stiffness].row + part.row), at_rest};
}

template <GatherMode kMode, typename Number>
constexpr int kOffsetsOf = SpringSlice<Number>{.gather = kMode}.offsets();

// Adds the spring forces of kTogether columns. Their operations are interleaved to hide latency.
template <bool kUniform, GatherMode kMode, int kTogether, typename Number>
HWY_INLINE void AddForces(const Part<Number>& part, std::int64_t first, const std::int32_t* offsets, const Number* x,
                          const Coordinates<Number>& own, Coordinates<Number>& sum) {
  constexpr int kOffsets = kOffsetsOf<kMode, Number>;
  const SliceTag<Number> d;
  const auto shortest = hn::Set(d, kShortestSquared<Number>);
  Coordinates<Number> edge[kTogether];
  hn::Vec<SliceTag<Number>> inverse[kTogether];  // first l^2, then 1/l
#pragma GCC unroll 3
  for (int i = 0; i < kTogether; ++i) {
    const Coordinates<Number> other = GatherColumn<kMode>(x, offsets + i * kOffsets, part.row);
    edge[i] = {hn::Sub(other.x, own.x), hn::Sub(other.y, own.y), hn::Sub(other.z, own.z)};
    const auto& [dx, dy, dz] = edge[i];
    inverse[i] = hn::Max(hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz)), shortest);
  }
  InvertRoots(d, inverse);
#pragma GCC unroll 3
  for (int i = 0; i < kTogether; ++i) {
    const Column<Number> column = ColumnAt<kUniform>(part, first + i);
    const auto coefficient = hn::Sub(column.stiffness, hn::Mul(column.at_rest, inverse[i]));
    sum.x = hn::Add(sum.x, hn::Mul(coefficient, edge[i].x));
    sum.y = hn::Add(sum.y, hn::Mul(coefficient, edge[i].y));
    sum.z = hn::Add(sum.z, hn::Mul(coefficient, edge[i].z));
  }
}

// Returns the sums of the spring forces on the part's rows.
template <bool kUniform, GatherMode kMode, typename Number>
HWY_INLINE Coordinates<Number> SumForces(const Part<Number>& part, const Number* x) {
  const SliceTag<Number> d;
  constexpr int kOffsets = kOffsetsOf<kMode, Number>;
  const SpringSlice<Number>& slice = part.slices.slices[part.slice];
  const std::int64_t end = part.slices.slices[part.slice + 1].first_column;
  const std::int32_t* offsets = &part.slices.offsets[slice.first_offset];
  const Coordinates<Number> own = GatherColumn<kMode>(x, offsets, part.row);
  offsets += kOffsets;
  Coordinates<Number> sum = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  std::int64_t c = slice.first_column;
  for (; c + 3 <= end; c += 3, offsets += 3 * kOffsets) AddForces<kUniform, kMode, 3>(part, c, offsets, x, own, sum);
  if (c + 2 == end) AddForces<kUniform, kMode, 2>(part, c, offsets, x, own, sum);
  if (c + 1 == end) AddForces<kUniform, kMode, 1>(part, c, offsets, x, own, sum);
  return sum;
}

template <typename Number>
HWY_INLINE void AddLoad(const Part<Number>& part, Coordinates<Number>& sum) {
  if (part.slices.load.empty()) return;
  const SliceTag<Number> d;
  const SliceLoad<Number>& load = part.slices.load[part.slice];
  sum.x = hn::Add(sum.x, hn::Load(d, load.x.row + part.row));
  sum.y = hn::Add(sum.y, hn::Load(d, load.y.row + part.row));
  sum.z = hn::Add(sum.z, hn::Load(d, load.z.row + part.row));
}

// The sums of one block by slot. Vector loads of a slot also read up to three numbers before and two after it.
template <typename Number>
class Tile {
 public:
  Tile() {
    for (int i = 0; i < 4; ++i) begin()[kNoSlot<Number> + i] = 0;
  }
  Number* begin() { return numbers_ + kAhead; }

 private:
  static constexpr int kAhead = kSliceRows<Number>;  // keeps slots aligned
  alignas(64) Number numbers_[kAhead + kNoSlot<Number> + 8];
};

template <bool kUniform, typename Number>
HWY_INLINE Coordinates<Number> SumForces(const Part<Number>& part, const Number* x) {
  switch (part.slices.slices[part.slice].gather) {
    case GatherMode::kInPairs:
      return SumForces<kUniform, GatherMode::kInPairs>(part, x);
    case GatherMode::kOneByOne:
      return SumForces<kUniform, GatherMode::kOneByOne>(part, x);
    case GatherMode::kAtEnd:
      break;
  }
  return SumForces<kUniform, GatherMode::kAtEnd>(part, x);
}

// Not inlined: compilers would duplicate it in each caller.
template <typename Number>
HWY_NOINLINE void FillTile(const SpringSlices<Number>& slices, std::int64_t block, Number scale, const Number* x,
                           Number* tile) {
  const auto factor = hn::Set(SliceTag<Number>(), scale);
  const std::int64_t first = slices.blocks[block].first_slice, end = slices.blocks[block + 1].first_slice;
  for (std::int64_t s = first; s < end; ++s, tile += 4 * kSliceRows<Number>) {
    const SpringSlice<Number>& slice = slices.slices[s];
    for (int row = 0; row < slice.rows; row += kWidth<Number>) {
      const Part<Number> part = {slices, s, row};
      Coordinates<Number> sum = slice.first_stiffness < 0 ? SumForces<true>(part, x) : SumForces<false>(part, x);
      AddLoad(part, sum);
      ToSlots({hn::Mul(factor, sum.x), hn::Mul(factor, sum.y), hn::Mul(factor, sum.z)}, row, tile);
    }
  }
}

template <bool kFresh, typename Number>
HWY_INLINE void AddSlot(const Number* slot, double* point) {
  for (int c = 0; c < 3; ++c) point[c] = (kFresh ? 0 : point[c]) + static_cast<double>(slot[c]);
}

#if HWY_TARGET != HWY_SCALAR
using FourDoubles = hn::CappedTag<double, 4>;

// Adds the sums at four slots to four consecutive points at f.
template <bool kFresh, typename Number>
HWY_INLINE void AddFour(const Number* tile, const std::uint16_t* slot, double* f) {
  const hn::Rebind<Number, FourDoubles> four;
  const FourDoubles d;
  const auto doubles = [](auto numbers) {
    if constexpr (std::is_same_v<Number, float>) {
      return hn::PromoteTo(FourDoubles(), numbers);
    } else {
      return numbers;
    }
  };
  const Number *p0 = tile + slot[0], *p1 = tile + slot[1], *p2 = tile + slot[2], *p3 = tile + slot[3];
  const auto xyzx = hn::IfThenElse(hn::FirstN(four, 3), hn::LoadU(four, p0), hn::LoadU(four, p1 - 3));
  const auto yzxy = hn::ConcatUpperLower(four, hn::LoadU(four, p2 - 2), hn::LoadU(four, p1 + 1));
  const auto zxyz = hn::IfThenElse(hn::FirstN(four, 1), hn::LoadU(four, p2 + 2), hn::LoadU(four, p3 - 1));
  const auto add = [d](auto numbers, double* to) {
    hn::StoreU(kFresh ? numbers : hn::Add(hn::LoadU(d, to), numbers), d, to);
  };
  add(doubles(xyzx), f), add(doubles(yzxy), f + 4), add(doubles(zxyz), f + 8);
}
#endif

// Adds the sums of a block whose vertices are consecutive in f; `f` points to the first.
template <bool kFresh, typename Number>
HWY_INLINE void AddWhole(const SpringSlices<Number>& slices, const VertexRange& range, const Number* tile, double* f) {
  const std::uint16_t* const slot = slices.slot.data();
  Eigen::Index v = range.first;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(FourDoubles()) == 4) {
    for (; v + 4 <= range.end; v += 4) AddFour<kFresh>(tile, slot + v, f + 3 * (v - range.first));
  }
#endif
  for (; v < range.end; ++v) AddSlot<kFresh>(tile + slot[v], f + 3 * (v - range.first));
}

template <typename Number>
HWY_INLINE void AddRowByRow(const SpringSlices<Number>& slices, std::int64_t block, const Number* tile,
                            std::int64_t first_vertex, double* f) {
  const std::int64_t first = slices.blocks[block].first_slice, end = slices.blocks[block + 1].first_slice;
  for (std::int64_t s = first; s < end; ++s) {
    const SpringSlice<Number>& slice = slices.slices[s];
    for (int row = 0; row < slice.rows; ++row) {
      const std::int64_t position = slices.VertexOf(s, row);
      const std::int64_t vertex = slices.order.empty() ? position - first_vertex : slices.order[position];
      AddSlot<false>(tile + SlotOf<Number>(s - first, row), f + 3 * vertex);
    }
  }
}

template <bool kFresh, typename Number>
HWY_INLINE void AddBlocks(const SpringSlices<Number>& slices, std::int64_t begin, std::int64_t end, double scale,
                          const Number* x, double* f) {
  Tile<Number> memory;
  Number* const tile = memory.begin();
  for (std::int64_t b = begin; b < end; ++b) {
    FillTile(slices, b, static_cast<Number>(scale), x, tile);
    const auto count = static_cast<Eigen::Index>(slices.slot.size());
    const VertexRange range = {b * kVertexBlock, std::min((b + 1) * kVertexBlock, count)};
    double* const own = f + 3 * (b - begin) * kVertexBlock;
    if (kFresh || slices.blocks[b].whole) {
      AddWhole<kFresh>(slices, range, tile, own);
    } else {
      AddRowByRow(slices, b, tile, begin * kVertexBlock, f);
    }
  }
}

void AddInDouble(const SpringSlices<double>& slices, std::int64_t begin, std::int64_t end, double scale,
                 const double* x, bool fresh, double* f) {
  fresh ? AddBlocks<true>(slices, begin, end, scale, x, f) : AddBlocks<false>(slices, begin, end, scale, x, f);
}

void AddInSingle(const SpringSlices<float>& slices, std::int64_t begin, std::int64_t end, double scale, const float* x,
                 bool fresh, double* f) {
  fresh ? AddBlocks<true>(slices, begin, end, scale, x, f) : AddBlocks<false>(slices, begin, end, scale, x, f);
}

#if HWY_TARGET <= HWY_AVX3
// Packs eight points at a time: three full vectors of coordinates. Returns the first vertex that is not packed.
HWY_INLINE Eigen::Index PackEights(const VertexRange& range, const double* x, const double* origin, float* packed) {
  const hn::FixedTag<double, 8> d;
  const hn::FixedTag<float, 8> half;
  const hn::FixedTag<float, 16> whole;
  HWY_ALIGN double repeated[24];
  for (int i = 0; i < 24; ++i) repeated[i] = origin[i % 3];
  HWY_ALIGN static constexpr std::int32_t kFirst[16] = {0, 1, 2, 0, 3, 4, 5, 0, 6, 7, 8, 0, 9, 10, 11, 0};
  HWY_ALIGN static constexpr std::int32_t kLast[16] = {4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0, 13, 14, 15, 0};
  const auto first = hn::SetTableIndices(whole, kFirst), last = hn::SetTableIndices(whole, kLast);
  const auto a0 = hn::Load(d, repeated), b0 = hn::Load(d, repeated + 8), c0 = hn::Load(d, repeated + 16);
  Eigen::Index v = range.first;
  for (; v + 8 <= range.end; v += 8) {
    const double* const from = x + 3 * v;
    const auto a = hn::DemoteTo(half, hn::Sub(hn::LoadU(d, from), a0));
    const auto b = hn::DemoteTo(half, hn::Sub(hn::LoadU(d, from + 8), b0));
    const auto c = hn::DemoteTo(half, hn::Sub(hn::LoadU(d, from + 16), c0));
    hn::StoreU(hn::TableLookupLanes(hn::Combine(whole, b, a), first), whole, packed + 4 * v);
    hn::StoreU(hn::TableLookupLanes(hn::Combine(whole, c, b), last), whole, packed + 4 * v + 16);
  }
  return v;
}
#endif

void PackHere(const VertexRange& range, const double* x, const double* origin, float* packed) {
  Eigen::Index v = range.first;
#if HWY_TARGET <= HWY_AVX3
  v = PackEights(range, x, origin, packed);
#endif
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(FourDoubles()) == 4) {
    const FourDoubles d;
    const hn::Rebind<float, FourDoubles> four;
    HWY_ALIGN const double at[4] = {origin[0], origin[1], origin[2], 0};
    const auto from = hn::Load(d, at);
    for (; v + 1 < range.end; ++v) {
      hn::Store(hn::DemoteTo(four, hn::Sub(hn::LoadU(d, x + 3 * v), from)), four, packed + 4 * v);
    }
  }
#endif
  for (; v < range.end; ++v) {
    for (int c = 0; c < 3; ++c) packed[4 * v + c] = static_cast<float>(x[3 * v + c] - origin[c]);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddInDouble);
HWY_EXPORT(AddInSingle);
HWY_EXPORT(PackHere);

void AddSprings(const SpringSlices<double>& slices, std::int64_t first, std::int64_t end, double scale, const double* x,
                bool fresh, double* f) {
  HWY_DYNAMIC_DISPATCH(AddInDouble)(slices, first, end, scale, x, fresh, f);
}

void AddSprings(const SpringSlices<float>& slices, std::int64_t first, std::int64_t end, double scale, const float* x,
                bool fresh, double* f) {
  HWY_DYNAMIC_DISPATCH(AddInSingle)(slices, first, end, scale, x, fresh, f);
}

void PackPoints(const VertexRange& range, const double* x, const double* origin, float* packed) {
  HWY_DYNAMIC_DISPATCH(PackHere)(range, x, origin, packed);
}

}  // namespace phrenic
#endif  // HWY_ONCE
