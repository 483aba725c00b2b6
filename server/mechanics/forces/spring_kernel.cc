#include "server/mechanics/forces/spring_kernel.h"

#include <algorithm>

// Targets whose vectors have no size that the compiler knows: their machines take NEON and the portable path.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
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

// The points at these places, transposed: one vector of every x, one of every y, one of every z.
template <typename Places>
HWY_INLINE Vectors Transposed(const double* packed, const Places& place) {
  const Tag d;
#if HWY_TARGET == HWY_SCALAR
  return {hn::Load(d, packed + place(0)), hn::Load(d, packed + place(0) + 1), hn::Load(d, packed + place(0) + 2)};
#elif HWY_TARGET == HWY_AVX3
  const hn::Half<Tag> half;
  const auto pair = [&](int i) {
    return hn::Combine(d, hn::Load(half, packed + place(i + 4)), hn::Load(half, packed + place(i)));
  };
  const auto a = pair(0), b = pair(1), c = pair(2), e = pair(3);
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01), hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01),
          hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01))};
#elif HWY_TARGET == HWY_AVX2
  const auto a = hn::Load(d, packed + place(0)), b = hn::Load(d, packed + place(1));
  const auto c = hn::Load(d, packed + place(2)), e = hn::Load(d, packed + place(3));
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::ConcatLowerLower(d, xz23, xz01), hn::ConcatLowerLower(d, y23, y01), hn::ConcatUpperUpper(d, xz23, xz01)};
#else
  const auto a = hn::Load(d, packed + place(0)), b = hn::Load(d, packed + place(1));
  const auto az = hn::Load(d, packed + place(0) + 2), bz = hn::Load(d, packed + place(1) + 2);
  return {hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveLower(d, az, bz)};
#endif
}

// f += scale sum, row by row.
HWY_INLINE void AddRows(const Vectors& sum, double scale, const int* vertices, size_t rows, double* f) {
  const Tag d;
  HWY_ALIGN double x[kLanes], y[kLanes], z[kLanes];
  hn::Store(hn::Mul(hn::Set(d, scale), sum.x), d, x);
  hn::Store(hn::Mul(hn::Set(d, scale), sum.y), d, y);
  hn::Store(hn::Mul(hn::Set(d, scale), sum.z), d, z);
  for (size_t i = 0; i < rows; ++i) {
    double* const force = f + 3 * static_cast<std::ptrdiff_t>(vertices[i]);
    force[0] += x[i], force[1] += y[i], force[2] += z[i];
  }
}

// Sum of the pulls on kLanes rows of a slice, from row `first` of it on; `own` are their positions.
HWY_INLINE Vectors SumPulls(const SpringSlices& slices, size_t slice, size_t first, const double* packed,
                            const Vectors& own) {
  const Tag d;
  const auto one = hn::Set(d, 1), shortest = hn::Set(d, kShortestSquared);
  Vectors sum = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const std::int64_t end = slices.first_column[slice + 1];
  for (std::int64_t c = slices.first_column[slice]; c < end; ++c) {
    const std::int32_t* const place = slices.neighbours[c].place + first;
    const SpringColumn& column = slices.columns[c];
    const Vectors other = Transposed(packed, [place](int i) { return place[i]; });
    const auto dx = hn::Sub(other.x, own.x), dy = hn::Sub(other.y, own.y), dz = hn::Sub(other.z, own.z);
    const auto squared = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto inverse = hn::Div(one, hn::Sqrt(hn::Max(squared, shortest)));
    const auto pull =
        hn::Sub(hn::Load(d, column.stiffness + first), hn::Mul(hn::Load(d, column.at_rest + first), inverse));
    sum.x = hn::Add(sum.x, hn::Mul(pull, dx));
    sum.y = hn::Add(sum.y, hn::Mul(pull, dy));
    sum.z = hn::Add(sum.z, hn::Mul(pull, dz));
  }
  return sum;
}

HWY_INLINE void AddLoad(const SpringSlices& slices, size_t slice, size_t first, Vectors& sum) {
  if (slices.load.empty()) return;
  const Tag d;
  const SliceLoad& load = slices.load[slice];
  sum.x = hn::Add(sum.x, hn::Load(d, load.x + first));
  sum.y = hn::Add(sum.y, hn::Load(d, load.y + first));
  sum.z = hn::Add(sum.z, hn::Load(d, load.z + first));
}

void AddAllSlices(const SpringSlices& slices, double scale, const double* packed, double* f) {
  const size_t rows = slices.vertices.size();
  for (size_t row = 0; row < rows; row += kLanes) {
    const size_t slice = row / kSliceRows, first = row % kSliceRows;
    const Vectors own = Transposed(packed + row * kPackedStride, [](int i) { return i * kPackedStride; });
    Vectors sum = SumPulls(slices, slice, first, packed, own);
    AddLoad(slices, slice, first, sum);
    AddRows(sum, scale, slices.vertices.data() + row, std::min(kLanes, rows - row), f);
  }
}

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(AddAllSlices);

void AddSlices(const SpringSlices& slices, double scale, const PackedPoint* packed, double* f) {
  HWY_DYNAMIC_DISPATCH(AddAllSlices)(slices, scale, &packed->x, f);
}

}  // namespace phrenic
#endif  // HWY_ONCE
