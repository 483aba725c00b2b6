// 1/sqrt(x), alone or with others that share its division: as near as is said, over all lengths that a spring may have.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/mechanics/every_target.h"
#include "tests/mechanics/inverse_root_kernel.h"

namespace phrenic {
namespace {

// The largest error of the six [units in the last place of the largest number of this exponent].
template <typename Number>
double Off(Number x) {
  const long double exact = 1 / std::sqrt(static_cast<long double>(x));
  const auto unit = std::ldexp(static_cast<long double>(std::numeric_limits<Number>::epsilon()), std::ilogb(exact));
  double largest = 0;
  for (const Number root : InverseRoots(x)) {
    largest = std::max(largest, static_cast<double>(std::abs(root - exact) / unit));
  }
  return largest;
}

template <typename Number>
double LargestOff(int exponent) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> mantissa(1, 4), power(-exponent, exponent);
  double largest = Off(Number{1});
  for (int i = 0; i < 100'000; ++i) {
    largest =
        std::max(largest, Off(static_cast<Number>(std::ldexp(mantissa(random), static_cast<int>(power(random))))));
  }
  return largest;
}

TEST(InverseRoots, AreOffByFourUnitsInTheLastPlaceAtMost) {
  OnEveryTarget([] {
    EXPECT_LE(LargestOff<double>(655), 4);
    EXPECT_LE(LargestOff<float>(120), 2);
  });
}

TEST(InverseRoots, AreTheSameBitsOnEveryInstructionSet) {
  for (const double x : {1e-200, 3e-9, 0.02, 1.0, 1.7, 2.0, 1e12}) {
    const SixRoots<double> here = InverseRoots(x);
    const SixRoots<float> single = InverseRoots(static_cast<float>(std::max(x, 1e-30)));
    OnEveryTarget([&] {
      EXPECT_EQ(InverseRoots(x), here);
      EXPECT_EQ(InverseRoots(static_cast<float>(std::max(x, 1e-30))), single);
    });
  }
}

}  // namespace
}  // namespace phrenic
