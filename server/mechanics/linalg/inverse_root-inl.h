// 1/sqrt(x) of several vectors at once. Roots and divisions go through one unit of a processor, one after the other; on
// some machines those of doubles take longer than all else of a spring. Three vectors share one division, therefore. To
// be included between the namespaces of a file that Google Highway compiles once for each instruction set, after
// <hwy/highway.h>.
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

// x <- 1/sqrt(x), off by four units in the last place at most; the same bits on every machine. Doubles lie between
// 1e-200 and 1e200: each root's inverse is taken from that of the product of all (Montgomery, Math Comp 1987;48:243),
// which three of them leave within range.
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
