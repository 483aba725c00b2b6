#include "tests/mechanics/inverse_root_kernel.h"

#include "server/mechanics/linalg/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/mechanics/inverse_root_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "server/mechanics/linalg/inverse_root-inl.h"

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {
namespace {

// x, 4 x and 16 x in the vectors: times 1, 2 and 4 each gives the same.
template <int kCount, typename Number>
void Together(Number x, Number* roots) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<Number, 8> d;
  hn::Vec<decltype(d)> vectors[kCount];
  for (int i = 0; i < kCount; ++i) vectors[i] = hn::Set(d, x * static_cast<Number>(1 << (2 * i)));
  InvertRoots(d, vectors);
  for (int i = 0; i < kCount; ++i) roots[i] = hn::GetLane(vectors[i]) * static_cast<Number>(1 << i);
}

template <typename Number>
SixRoots<Number> Six(Number x) {
  SixRoots<Number> roots;
  Together<1>(x, roots.data());
  Together<2>(x, roots.data() + 1);
  Together<3>(x, roots.data() + 3);
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
