// The rotation in a deformation gradient: F = R S, S symmetric (the polar decomposition).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_

#include <Eigen/Core>

namespace phrenic {

// How N coordinates of an element at rest (2 of a triangle, 3 of a tetrahedron) became three in space.
template <int N>
using Gradient = Eigen::Matrix<double, 3, N>;

// The R nearest to F, R^T R = I, to rounding. Where F is so degenerate that there are several, one of them. Of a
// triangle: R = (F + cofactor(F)) / tr S, exact. Of a tetrahedron: det R = 1 even where it is turned inside out;
// Newton's iteration (Higham 1986), the singular value decomposition where F is nearly flat or inverted.
Gradient<2> NearestRotation(const Gradient<2>& f);
Gradient<3> NearestRotation(const Gradient<3>& f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_
