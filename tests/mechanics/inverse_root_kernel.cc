#include "tests/mechanics/inverse_root_kernel.h"

#include "server/mechanics/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/mechanics/inverse_root_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/inverse_root-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

template <typename Number>
SixRoots<Number> Six(Number x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<Number, 8> d;
  hn::Vec<decltype(d)> vectors[6];
  for (auto& vector : vectors) vector = hn::Set(d, x);
  InvertRoots(d, vectors);
  SixRoots<Number> roots;
  for (int i = 0; i < 6; ++i) roots[i] = hn::GetLane(vectors[i]);
  return roots;
}

SixRoots<double> OfDouble(double x) { return Six(x); }
SixRoots<float> OfFloat(float x) { return Six(x); }

}  // namespace
}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace phrenic {

HWY_EXPORT(OfDouble);
HWY_EXPORT(OfFloat);

SixRoots<double> InverseRoots(double x) { return HWY_DYNAMIC_DISPATCH(OfDouble)(x); }
SixRoots<float> InverseRoots(float x) { return HWY_DYNAMIC_DISPATCH(OfFloat)(x); }

}  // namespace phrenic
#endif  // HWY_ONCE
