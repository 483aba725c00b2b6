// What server/mechanics/inverse_root-inl.h makes of one number alone, with another, and with two others, on the
// instruction set chosen.
#ifndef PHRENIC_TESTS_MECHANICS_INVERSE_ROOT_KERNEL_H_
#define PHRENIC_TESTS_MECHANICS_INVERSE_ROOT_KERNEL_H_

#include <array>

namespace phrenic {

template <typename Number>
using SixRoots = std::array<Number, 6>;

SixRoots<double> InverseRoots(double x);
SixRoots<float> InverseRoots(float x);

}  // namespace phrenic

#endif  // PHRENIC_TESTS_MECHANICS_INVERSE_ROOT_KERNEL_H_
