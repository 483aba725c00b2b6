#include "server/stream/codecs/encoding_kernel.h"

#include <algorithm>
#include <array>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/stream/codecs/encoding_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::stream::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kUnitBits = 12;
static_assert(kUnit == 1 << kUnitBits);

// Sets the steps of as many numbers as a vector has. Returns false as CountSteps.
HWY_INLINE bool CountVector(const float* moved, const float* rest, double inverse, std::int32_t* steps) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> floats;
  const hn::Rebind<std::int32_t, decltype(d)> integers;
  const auto wide = [&](const float* from) HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(floats, from)); };
  const auto scaled = hn::Mul(hn::Sub(wide(moved), wide(rest)), hn::Set(d, inverse));
  const auto count = hn::Floor(hn::Add(scaled, hn::Set(d, 0.5)));
  const auto near = hn::Le(hn::Abs(count), hn::Set(d, kFurthest));
  hn::StoreU(hn::DemoteTo(integers, hn::IfThenElseZero(near, count)), integers, steps);
  return hn::AllTrue(d, near);
}

bool CountStepsHere(const float* moved, const float* rest, std::size_t size, double inverse, std::int32_t* steps) {
  constexpr std::size_t kLanes = hn::MaxLanes(hn::ScalableTag<double>());
  bool near = true;
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes) near = CountVector(moved + i, rest + i, inverse, steps + i) && near;
  std::array<float, kLanes> last_moved = {}, last_rest = {};
  std::array<std::int32_t, kLanes> last = {};
  std::copy(moved + i, moved + size, last_moved.begin());
  std::copy(rest + i, rest + size, last_rest.begin());
  near = CountVector(last_moved.data(), last_rest.data(), inverse, last.data()) && near;
  std::copy_n(last.begin(), size - i, steps + i);
  return near;
}

#if HWY_TARGET <= HWY_AVX2
// The products of 32-bit numbers are exact in 64 bits, and bits 12 to 43 of the sum are its floor over 2^12 modulo
// 2^32. Reads and writes a fourth number, which belongs to the next place.
HWY_INLINE void SetResidual(const NeighbourWeights& neighbours, const std::int32_t* steps, std::size_t place,
                            std::int32_t* residuals) {
  const hn::FixedTag<std::int64_t, 4> d;
  const hn::FixedTag<std::uint64_t, 4> bits;
  const hn::FixedTag<std::int32_t, 8> halves;
  const hn::FixedTag<std::int32_t, 4> integers;
  const auto at = [&](std::size_t other) HWY_ATTR { return hn::LoadU(integers, steps + 3 * other); };
  auto sum = hn::Set(d, kUnit / 2);
  for (int i = neighbours.first[place]; i < neighbours.first[place + 1]; ++i) {
    const auto other = hn::PromoteTo(d, at(static_cast<std::size_t>(neighbours.places[static_cast<std::size_t>(i)])));
    const auto weight = hn::Set(d, neighbours.weights[static_cast<std::size_t>(i)]);
    sum = hn::Add(sum, hn::MulEven(hn::BitCast(halves, other), hn::BitCast(halves, weight)));
  }
  const auto predicted =
      hn::TruncateTo(hn::FixedTag<std::uint32_t, 4>(), hn::ShiftRight<kUnitBits>(hn::BitCast(bits, sum)));
  hn::StoreU(hn::Sub(at(place), hn::BitCast(integers, predicted)), integers, residuals + 3 * place);
}
#endif

void SetResidualOf(const NeighbourWeights& neighbours, const std::int32_t* steps, std::size_t place,
                   std::int32_t* residuals) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::int64_t sum = kUnit / 2;
    for (int i = neighbours.first[place]; i < neighbours.first[place + 1]; ++i) {
      const auto k = static_cast<std::size_t>(i);
      sum += std::int64_t{neighbours.weights[k]} * steps[3 * static_cast<std::size_t>(neighbours.places[k]) + axis];
    }
    residuals[3 * place + axis] = static_cast<std::int32_t>(steps[3 * place + axis] - (sum >> kUnitBits));
  }
}

void SetResidualsHere(const NeighbourWeights& neighbours, const std::int32_t* steps, std::size_t places,
                      std::int32_t* residuals) {
  std::size_t place = 0;
#if HWY_TARGET <= HWY_AVX2
  for (; place + 1 < places; ++place) SetResidual(neighbours, steps, place, residuals);
#endif
  for (; place < places; ++place) SetResidualOf(neighbours, steps, place, residuals);
}

}  // namespace
}  // namespace phrenic::stream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic::stream {

HWY_EXPORT(CountStepsHere);
HWY_EXPORT(SetResidualsHere);

bool CountSteps(const std::vector<float>& moved, const std::vector<float>& rest, double inverse, Steps& steps) {
  return HWY_DYNAMIC_DISPATCH(CountStepsHere)(moved.data(), rest.data(), steps.size(), inverse, steps.data());
}

void SetResiduals(const NeighbourWeights& neighbours, const Steps& steps, Steps& residuals) {
  HWY_DYNAMIC_DISPATCH(SetResidualsHere)(neighbours, steps.data(), steps.size() / 3, residuals.data());
}

}  // namespace phrenic::stream
#endif  // HWY_ONCE
