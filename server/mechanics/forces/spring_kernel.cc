#include "server/mechanics/forces/spring_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/spring_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, kSliceRows>;
using Vector = hn::Vec<Tag>;
constexpr size_t kLanes = hn::MaxLanes(Tag());
// [m^2]; keeps 1/l finite, so that l = 0 gives no force and no exception is made of it.
constexpr double kShortestSquared = 1e-300;
static_assert(kSliceRows % kLanes == 0);

struct Vectors {
  Vector x, y, z;
};

// Points one by one: reads nothing beyond them.
HWY_INLINE Vectors Gathered(const double* x, const std::int32_t* place) {
  const Tag d;
  HWY_ALIGN double values[3][kLanes];
  for (size_t i = 0; i < kLanes; ++i) {
    for (int c = 0; c < 3; ++c) values[c][i] = x[place[i] + c];
  }
  return {hn::Load(d, values[0]), hn::Load(d, values[1]), hn::Load(d, values[2])};
}

// The points at these places, transposed: one vector of every x, one of every y, one of every z. A point is one load,
// with what follows it: of the last of all only where `kAtEnd`.
template <bool kAtEnd>
HWY_INLINE Vectors Transposed(const double* x, const std::int32_t* place) {
#if HWY_TARGET == HWY_SCALAR
  return Gathered(x, place);
#else
  if constexpr (kAtEnd) return Gathered(x, place);
  const Tag d;
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<Tag> half;
  const auto pair = [&](int i) {
    return hn::Combine(d, hn::LoadU(half, x + place[i + 4]), hn::LoadU(half, x + place[i]));
  };
  const auto a = pair(0), b = pair(1), c = pair(2), e = pair(3);
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01), hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01),
          hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01))};
#elif HWY_TARGET == HWY_AVX2
  const auto a = hn::LoadU(d, x + place[0]), b = hn::LoadU(d, x + place[1]);
  const auto c = hn::LoadU(d, x + place[2]), e = hn::LoadU(d, x + place[3]);
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::ConcatLowerLower(d, xz23, xz01), hn::ConcatLowerLower(d, y23, y01), hn::ConcatUpperUpper(d, xz23, xz01)};
#else
  const auto a = hn::LoadU(d, x + place[0]), b = hn::LoadU(d, x + place[1]);
  const auto az = hn::LoadU(d, x + place[0] + 2), bz = hn::LoadU(d, x + place[1] + 2);
  return {hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveLower(d, az, bz)};
#endif
#endif
}

// kLanes rows of a slice; every slice has kParts of them.
struct Part {
  const SpringSlice& slice;
  std::int64_t number;  // of the slice
  int first_row;
  std::int64_t end_column;
};
constexpr int kParts = static_cast<int>(kSliceRows / kLanes);

HWY_INLINE Part PartOf(const SpringSlices& slices, std::int64_t part) {
  const std::int64_t number = part / kParts;
  const SpringSlice& slice = slices.slices[number];
  return {slice, number, static_cast<int>(part % kParts * kLanes), slices.slices[number + 1].first_column};
}

// Sum of the pulls on the part's rows.
template <bool kAlike, bool kAtEnd>
HWY_INLINE Vectors SumPulls(const SpringSlices& slices, const Part& part, const double* x) {
  const Tag d;
  const auto common = hn::Set(d, slices.common_stiffness), shortest = hn::Set(d, kShortestSquared);
  const Vectors own = Transposed<kAtEnd>(x, part.slice.own + part.first_row);
  Vectors sum = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::int64_t c = part.slice.first_column; c < part.end_column; ++c) {
    const Vectors other = Transposed<kAtEnd>(x, slices.neighbours[c].place + part.first_row);
    const auto dx = hn::Sub(other.x, own.x), dy = hn::Sub(other.y, own.y), dz = hn::Sub(other.z, own.z);
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto stiffness = kAlike ? common : hn::Load(d, slices.stiffness[c].k + part.first_row);
    const auto at_rest = hn::Load(d, slices.columns[c].at_rest + part.first_row);
    const auto pull = hn::Sub(stiffness, hn::Div(at_rest, hn::Sqrt(hn::Max(squared, shortest))));
    sum.x = hn::Add(sum.x, hn::Mul(pull, dx));
    sum.y = hn::Add(sum.y, hn::Mul(pull, dy));
    sum.z = hn::Add(sum.z, hn::Mul(pull, dz));
  }
  return sum;
}

HWY_INLINE void AddLoad(const SpringSlices& slices, const Part& part, Vectors& sum) {
  if (slices.load.empty()) return;
  const Tag d;
  const SliceLoad& load = slices.load[part.number];
  sum.x = hn::Add(sum.x, hn::Load(d, load.x + part.first_row));
  sum.y = hn::Add(sum.y, hn::Load(d, load.y + part.first_row));
  sum.z = hn::Add(sum.z, hn::Load(d, load.z + part.first_row));
}

struct Rows {
  HWY_ALIGN double even[kLanes], odd[kLanes], z[kLanes];
};

HWY_INLINE void AddRow(const Rows& sums, int row, double* force) {
#if HWY_TARGET == HWY_SCALAR
  force[0] += sums.even[row], force[1] += sums.odd[row];
#else
  const hn::FixedTag<double, 2> both;
  const auto xy = hn::Load(both, (row % 2 == 0 ? sums.even : sums.odd) + row / 2 * 2);
  hn::StoreU(hn::Add(hn::LoadU(both, force), xy), both, force);
#endif
  force[2] += sums.z[row];
}

// f += scale sum, row by row.
HWY_INLINE void AddRows(const Vectors& sum, double scale, const Part& part, double* f) {
  const Tag d;
  const auto factor = hn::Set(d, scale);
  const auto x = hn::Mul(factor, sum.x), y = hn::Mul(factor, sum.y);
  Rows sums;
  hn::Store(hn::Mul(factor, sum.z), d, sums.z);
#if HWY_TARGET == HWY_SCALAR
  hn::Store(x, d, sums.even), hn::Store(y, d, sums.odd);
#else
  hn::Store(hn::InterleaveLower(d, x, y), d, sums.even);
  hn::Store(hn::InterleaveUpper(d, x, y), d, sums.odd);
#endif
  const std::int32_t* const own = part.slice.own + part.first_row;
  const int rows = part.slice.rows - part.first_row;
  if (rows >= static_cast<int>(kLanes)) {
#pragma GCC unroll 8
    for (int i = 0; i < static_cast<int>(kLanes); ++i) AddRow(sums, i, f + own[i]);
  } else {
    for (int i = 0; i < rows; ++i) AddRow(sums, i, f + own[i]);
  }
}

template <bool kAlike>
void AddParts(const SpringSlices& slices, std::int64_t begin, std::int64_t end, double scale, const double* x,
              double* f) {
  for (std::int64_t p = begin; p < end; ++p) {
    const Part part = PartOf(slices, p);
    if (part.first_row >= part.slice.rows) continue;
    Vectors sum =
        part.slice.at_end ? SumPulls<kAlike, true>(slices, part, x) : SumPulls<kAlike, false>(slices, part, x);
    AddLoad(slices, part, sum);
    AddRows(sum, scale, part, f);
  }
}

void AddSlicesHere(const SpringSlices& slices, std::int64_t begin, std::int64_t end, double scale, const double* x,
                   double* f) {
  if (slices.stiffness.empty()) {
    AddParts<true>(slices, begin * kParts, end * kParts, scale, x, f);
  } else {
    AddParts<false>(slices, begin * kParts, end * kParts, scale, x, f);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddSlicesHere);

void AddSlices(const SpringSlices& slices, std::int64_t first, std::int64_t end, double scale, const double* x,
               double* f) {
  HWY_DYNAMIC_DISPATCH(AddSlicesHere)(slices, first, end, scale, x, f);
}

}  // namespace phrenic
#endif  // HWY_ONCE
