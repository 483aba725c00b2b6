// Loads and stores of points of a 3 x n array as vectors of coordinates. To be included by a file that Google Highway
// compiles once for each instruction set, after <hwy/highway.h>.
#if defined(PHRENIC_SERVER_MECHANICS_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHRENIC_SERVER_MECHANICS_POINTS_INL_H_
#undef PHRENIC_SERVER_MECHANICS_POINTS_INL_H_
#else
#define PHRENIC_SERVER_MECHANICS_POINTS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace points {

namespace hn = hwy::HWY_NAMESPACE;

// Eight points at most: what comes in packets and slices of eight is one vector, two or four.
using Tag = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Tag>;
constexpr size_t kLanes = hn::MaxLanes(Tag());

struct Vectors {
  Vector x, y, z;
};

#if HWY_TARGET <= HWY_AVX2
// Points that `point` gives by their lanes, as x, y, z and anything, transposed: one vector of every x, one of every y,
// one of every z.
template <typename Point>
HWY_INLINE Vectors Columns(const Point& point) {
  const Tag d;
#if HWY_TARGET <= HWY_AVX3
  const auto pair = [&](int i) HWY_ATTR { return hn::Combine(d, point(i + 4), point(i)); };
  const auto a = pair(0), b = pair(1), c = pair(2), e = pair(3);
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(xz23), xz01), hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01),
          hn::OddEvenBlocks(xz23, hn::SwapAdjacentBlocks(xz01))};
#else
  const auto a = point(0), b = point(1), c = point(2), e = point(3);
  const auto xz01 = hn::InterleaveLower(d, a, b), xz23 = hn::InterleaveLower(d, c, e);
  const auto y01 = hn::InterleaveUpper(d, a, b), y23 = hn::InterleaveUpper(d, c, e);
  return {hn::ConcatLowerLower(d, xz23, xz01), hn::ConcatLowerLower(d, y23, y01), hn::ConcatUpperUpper(d, xz23, xz01)};
#endif
}
#endif

// The points at these offsets [doubles], transposed: one vector of every x, one of every y, one of every z. A point is
// one load, with what follows it; where that may not be read, as after the last of all or where another thread writes
// it, `kAlone`.
template <bool kAlone, typename Offset>
HWY_INLINE Vectors Transposed(const double* x, const Offset* offset) {
#if HWY_TARGET == HWY_SCALAR
  const Tag d;
  return {hn::Load(d, x + *offset), hn::Load(d, x + *offset + 1), hn::Load(d, x + *offset + 2)};
#elif HWY_TARGET <= HWY_AVX2
  const hn::FixedTag<double, 4> four;
  return Columns([&](int i) HWY_ATTR {
    return kAlone ? hn::MaskedLoad(hn::FirstN(four, 3), four, x + offset[i]) : hn::LoadU(four, x + offset[i]);
  });
#else
  const Tag d;
  const auto a = hn::LoadU(d, x + offset[0]), b = hn::LoadU(d, x + offset[1]);
  const auto a_yz = hn::LoadU(d, x + offset[0] + 1), b_yz = hn::LoadU(d, x + offset[1] + 1);
  return {hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveUpper(d, a_yz, b_yz)};
#endif
}

// Vectors of coordinates as points again.
struct Rows {
  HWY_ALIGN double even[kLanes], odd[kLanes], z[kLanes];
};

HWY_INLINE Rows ToRows(const Vectors& sum) {
  const Tag d;
  Rows rows;
  hn::Store(sum.z, d, rows.z);
#if HWY_TARGET == HWY_SCALAR
  hn::Store(sum.x, d, rows.even), hn::Store(sum.y, d, rows.odd);
#else
  hn::Store(hn::InterleaveLower(d, sum.x, sum.y), d, rows.even);
  hn::Store(hn::InterleaveUpper(d, sum.x, sum.y), d, rows.odd);
#endif
  return rows;
}

HWY_INLINE void AddRow(const Rows& rows, int row, double* point) {
#if HWY_TARGET == HWY_SCALAR
  point[0] += rows.even[row], point[1] += rows.odd[row];
#else
  const hn::FixedTag<double, 2> both;
  const auto xy = hn::Load(both, (row % 2 == 0 ? rows.even : rows.odd) + row / 2 * 2);
  hn::StoreU(hn::Add(hn::LoadU(both, point), xy), both, point);
#endif
  point[2] += rows.z[row];
}

// The points at the first `count` offsets += rows.
template <typename Offset>
HWY_INLINE void AddRows(const Rows& rows, const Offset* offset, int count, double* x) {
  if (count >= static_cast<int>(kLanes)) {
#pragma GCC unroll 8
    for (int i = 0; i < static_cast<int>(kLanes); ++i) AddRow(rows, i, x + offset[i]);
  } else {
    for (int i = 0; i < count; ++i) AddRow(rows, i, x + offset[i]);
  }
}

// The largest magnitude of numbers. As whole numbers: without their signs numbers are in the order of their bits,
// infinity above all, and what is no number above that.
class Largest {
 public:
  Largest() : magnitude_(hn::Zero(Bits())) {}
  HWY_INLINE void Note(Vector numbers) { magnitude_ = hn::Max(magnitude_, hn::BitCast(Bits(), hn::Abs(numbers))); }
  HWY_INLINE void Note(const Vectors& v) { Note(v.x), Note(v.y), Note(v.z); }
  double Whole() const {
    HWY_ALIGN std::int64_t all[kLanes];
    hn::Store(magnitude_, Bits(), all);
    return std::bit_cast<double>(*std::max_element(all, all + kLanes));
  }

 private:
  using Bits = hn::RebindToSigned<Tag>;
  hn::Vec<Bits> magnitude_;
};

}  // namespace points
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PHRENIC_SERVER_MECHANICS_POINTS_INL_H_
