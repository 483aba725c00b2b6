#include "server/stream/float_kernel.h"

#include <cmath>
#include <cstdint>

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "server/stream/float_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace phrenic::stream::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

bool ToFloatsHere(const double* from, std::size_t count, float* to) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> floats;
  const hn::RebindToSigned<decltype(floats)> bits;
  constexpr std::size_t kLanes = hn::MaxLanes(hn::ScalableTag<double>());
  const auto infinity = hn::Set(bits, 0x7F800000);  // no finite number has all of these bits
  auto finite = hn::Eq(infinity, infinity);
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    const auto numbers = hn::DemoteTo(floats, hn::LoadU(d, from + i));
    hn::StoreU(numbers, floats, to + i);
    finite = hn::And(finite, hn::Lt(hn::And(hn::BitCast(bits, numbers), infinity), infinity));
  }
  bool all = hn::AllTrue(bits, finite);
  for (; i < count; ++i) {
    to[i] = static_cast<float>(from[i]);
    all = all && std::isfinite(to[i]);
  }
  return all;
}

}  // namespace
}  // namespace phrenic::stream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic::stream {

HWY_EXPORT(ToFloatsHere);

bool ToFloats(const double* from, std::size_t count, float* to) {
  return HWY_DYNAMIC_DISPATCH(ToFloatsHere)(from, count, to);
}

}  // namespace phrenic::stream
#endif  // HWY_ONCE
