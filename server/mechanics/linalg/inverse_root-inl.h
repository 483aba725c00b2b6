// 1/sqrt(x) of several vectors at once. A processor has one unit for square roots and divisions, and on some machines
// those of doubles take longer than the rest of a spring. Three vectors therefore share one division. To be included by
// a file that Google Highway compiles once for each instruction set, after <hwy/highway.h>.
#if defined(PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#undef PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#else
#define PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#endif

#include <hwy/highway.h>

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {

// Replaces x by 1/sqrt(x), with an error of at most four units in the last place and the same bits on every machine.
// Requires of doubles: 1e-200 < x < 1e200, so that the product of three roots is in range: each inverse follows from
// the inverse of the product (Montgomery, Math Comp 1987;48:243).
template <typename Tag, int kCount>
HWY_INLINE void InvertRoots(Tag d, hwy::HWY_NAMESPACE::Vec<Tag> (&x)[kCount]) {
  namespace hn = hwy::HWY_NAMESPACE;
  static_assert(kCount <= 3);
  constexpr bool kAlone = std::is_same_v<hn::TFromD<Tag>, float>;
  const auto one = hn::Set(d, hn::TFromD<Tag>{1});
#pragma GCC unroll 3
  for (int i = 0; i < kCount; ++i) x[i] = hn::Sqrt(x[i]);
  if constexpr (kAlone) {
#pragma GCC unroll 3
    for (int i = 0; i < kCount; ++i) x[i] = hn::Div(one, x[i]);
  } else {
    hn::Vec<Tag> product[kCount] = {x[0]};  // of the roots up to this one
#pragma GCC unroll 2
    for (int i = 1; i < kCount; ++i) product[i] = hn::Mul(product[i - 1], x[i]);
    auto inverse = hn::Div(one, product[kCount - 1]);
#pragma GCC unroll 2
    for (int i = kCount - 1; i > 0; --i) {
      product[i] = hn::Mul(inverse, product[i - 1]);
      inverse = hn::Mul(inverse, x[i]);
      x[i] = product[i];
    }
    x[0] = inverse;
  }
}

}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
