// The polar decomposition of a deformation gradient, F = R S, R a rotation and S symmetric.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_

#include <Eigen/Core>

namespace phrenic {

// A deformation gradient: from N rest coordinates of an element (2 of a triangle, 3 of a tetrahedron) to space.
template <int N>
using Gradient = Eigen::Matrix<double, 3, N>;

// Returns the R nearest to F with R^T R = I, to rounding; one of them if F is so degenerate that it is not unique.
// Triangle: R = (F + cofactor(F)) / tr S in closed form. Tetrahedron: det R = 1 even if the element is inverted; Newton
// iteration (Higham 1986), or the singular value decomposition if F is nearly singular or inverted. Thread-safe.
Gradient<2> NearestRotation(const Gradient<2>& f);
Gradient<3> NearestRotation(const Gradient<3>& f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_POLAR_H_
