// The linear elastic brick: eight corners and trilinear displacement (T. Hughes, The Finite Element Method, 2000,
// section 3.4), of which a part is material.
#ifndef PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_ELEMENT_H_
#define PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_ELEMENT_H_

#include <Eigen/Core>
#include <vector>

#include "server/mechanics/lungs/brick_grid.h"

namespace phrenic {

// Rows and columns 3 c + axis, c the corner (brick_grid.h).
using BrickMatrix = Eigen::Matrix<double, 24, 24>;

// The stiffness of a cube of `edge` [m] of an isotropic material of Young's modulus 1, per modulus [m]: the integral
// over each of its parts by eight Gauss points. Immutable, thread-safe.
class BrickElement {
 public:
  // Requires: poisson in [0, 0.5).
  BrickElement(double edge, double poisson);

  // Returns the sum over the parts, each times its fraction of material or `least` [1] if that is more.
  BrickMatrix Stiffness(const BrickFractions& fractions, double least) const;

 private:
  std::vector<BrickMatrix> parts_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_LUNGS_BRICK_ELEMENT_H_
