#include "server/mechanics/forces/spring_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/mechanics/forces/spring_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using points::kLanes, points::Tag, points::Transposed, points::Vector, points::Vectors;

// [m^2]; keeps 1/l finite, so that l = 0 gives no force and no exception is made of it.
constexpr double kShortestSquared = 1e-300;
static_assert(kSliceRows % kLanes == 0);

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

// f += scale sum, row by row.
HWY_INLINE void AddSums(const Vectors& sum, double scale, const Part& part, double* f) {
  const auto factor = hn::Set(Tag(), scale);
  const auto rows = points::ToRows({hn::Mul(factor, sum.x), hn::Mul(factor, sum.y), hn::Mul(factor, sum.z)});
  points::AddRows(rows, part.slice.own + part.first_row, part.slice.rows - part.first_row, f);
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
    AddSums(sum, scale, part, f);
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
