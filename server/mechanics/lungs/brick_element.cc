#include "server/mechanics/lungs/brick_element.h"

#include <algorithm>
#include <cmath>

namespace phrenic {
namespace {

using StrainMatrix = Eigen::Matrix<double, 6, 24>;

// Strain (xx, yy, zz, 2 xy, 2 yz, 2 zx) per displacement of the corners [1/m].
StrainMatrix StrainOf(const BrickGradients& gradient) {
  StrainMatrix strain = StrainMatrix::Zero();
  for (int c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3;
      strain(axis, 3 * c + axis) = gradient(axis, c);
      strain(3 + axis, 3 * c + axis) = gradient(next, c);
      strain(3 + axis, 3 * c + next) = gradient(axis, c);
    }
  }
  return strain;
}

Eigen::Matrix<double, 6, 6> Elasticity(double poisson) {
  const double lambda = poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = 1 / (2 * (1 + poisson));
  Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
  c.topLeftCorner<3, 3>().setConstant(lambda);
  c.diagonal() << Eigen::Vector3d::Constant(lambda + 2 * mu), Eigen::Vector3d::Constant(mu);
  return c;
}

}  // namespace

BrickElement::BrickElement(double edge, double poisson) : parts_(kBrickParts, BrickMatrix::Zero()) {
  const Eigen::Matrix<double, 6, 6> elasticity = Elasticity(poisson);
  const double gauss[] = {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)};
  const double volume = std::pow(edge / kBrickSplit, 3) / 8;  // of a Gauss point
  for (int p = 0; p < kBrickParts; ++p) {
    const int row = p / kBrickSplit % kBrickSplit, layer = p / (kBrickSplit * kBrickSplit);
    const Eigen::Vector3d low(p % kBrickSplit, row, layer);
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d in_part(gauss[c & 1], gauss[c >> 1 & 1], gauss[c >> 2 & 1]);
      const StrainMatrix strain = StrainOf(GradientsAt((low + in_part) / kBrickSplit) / edge);
      parts_[p] += volume * strain.transpose() * elasticity * strain;
    }
  }
}

BrickMatrix BrickElement::Stiffness(const BrickFractions& fractions, double least) const {
  BrickMatrix stiffness = BrickMatrix::Zero();
  for (int p = 0; p < kBrickParts; ++p) stiffness += std::max<double>(fractions[p], least) * parts_[p];
  return stiffness;
}

}  // namespace phrenic
