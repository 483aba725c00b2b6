// 1/sqrt(x) of several vectors at once. Roots and divisions go through one unit of a processor, one after the other; on
// some machines they take longer than all else of a spring. Most are worked out in the units that multiply, therefore,
// and the others beside them. To be included between the namespaces of a file that Google Highway compiles once for
// each instruction set, after <hwy/highway.h>.
#if defined(PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#undef PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#else
#define PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace phrenic::HWY_NAMESPACE {

namespace inverse_root {

// By Newton's method for 1/y^2 = x, y <- y (3 - x y^2)/2, from a start that halves the exponent (off by 3.5 %; Lomont,
// "Fast inverse square root", 2003): a round takes a relative error e to 3/2 e^2.
template <int kCount, typename Tag>
HWY_INLINE void ByNewton(Tag d, hwy::HWY_NAMESPACE::Vec<Tag>* x) {
  namespace hn = hwy::HWY_NAMESPACE;
  using Number = hn::TFromD<Tag>;
  using Bits = std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint64_t>;
  constexpr auto kStart = static_cast<Bits>(sizeof(Number) == 4 ? 0x5f375a86 : 0x5fe6eb50c7b537a9);
  constexpr int kRounds = sizeof(Number) == 4 ? 3 : 4;
  const hn::RebindToUnsigned<Tag> bits;
  const auto half = hn::Set(d, Number{0.5}), three_halves = hn::Set(d, Number{1.5});
  hn::Vec<Tag> halves[kCount];
  for (int i = 0; i < kCount; ++i) {
    halves[i] = hn::Mul(half, x[i]);
    x[i] = hn::BitCast(d, hn::Sub(hn::Set(bits, kStart), hn::ShiftRight<1>(hn::BitCast(bits, x[i]))));
  }
#pragma GCC unroll 4
  for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 4
    for (int i = 0; i < kCount; ++i) {
      x[i] = hn::Mul(x[i], hn::Sub(three_halves, hn::Mul(hn::Mul(halves[i], x[i]), x[i])));
    }
  }
}

}  // namespace inverse_root

// x <- 1/sqrt(x) for normal x > 0, off by three units in the last place at most; the same bits on every machine. Of six
// vectors two by root and division, of three one.
template <typename Tag, int kCount>
HWY_INLINE void InvertRoots(Tag d, hwy::HWY_NAMESPACE::Vec<Tag> (&x)[kCount]) {
  namespace hn = hwy::HWY_NAMESPACE;
  static_assert(kCount == 1 || kCount == 3 || kCount == 6);
  constexpr int kByRoot = (kCount + 2) / 3;
  for (int i = 0; i < kByRoot; ++i) x[i] = hn::Sqrt(x[i]);
  if constexpr (kCount > kByRoot) inverse_root::ByNewton<kCount - kByRoot>(d, x + kByRoot);
  for (int i = 0; i < kByRoot; ++i) x[i] = hn::Div(hn::Set(d, hn::TFromD<Tag>{1}), x[i]);
}

}  // namespace phrenic::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PHRENIC_SERVER_MECHANICS_INVERSE_ROOT_INL_H_
