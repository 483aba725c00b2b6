#include "server/mechanics/lungs/brick_grid.h"

#include <gtest/gtest.h>

#include <numeric>

#include "server/mechanics/lungs/brick_element.h"
#include "server/mesh/ellipsoid.h"
#include "server/mesh/topology.h"

namespace phrenic {
namespace {

Mesh Ellipsoid() { return EllipsoidSurface({0.1, -0.02, 0.25}, {0.06, 0.085, 0.12}, 24, false); }

TEST(BrickGrid, HoldsTheVolumeOfTheSurface) {
  const Mesh surface = Ellipsoid();
  const double volume = SignedVolume(surface.vertices, surface.triangles);
  for (const double edge : {0.02, 0.014, 0.01}) {
    const BrickGrid grid(surface, edge);
    double parts = 0;
    for (const BrickFractions& fractions : grid.fractions()) {
      parts += std::accumulate(fractions.begin(), fractions.end(), 0.0);
      for (const float fraction : fractions) EXPECT_LE(fraction, 1 + 1e-5);
    }
    EXPECT_NEAR(parts * edge * edge * edge / kBrickParts, volume, 0.002 * volume);
  }
}

TEST(BrickGrid, InterpolatesLinearFieldsExactly) {
  const BrickGrid grid(Ellipsoid(), 0.014);
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -3, 0.5, -1, 4, 2, 0, 1;
  const Points field = gradient * grid.nodes();
  const Eigen::Vector3d inside(0.11, 0.03, 0.3), outside(0.1, -0.02, 0.375), far(0.6, 0, 0);
  for (const Eigen::Vector3d& point : {inside, outside}) {
    const auto [brick, local] = grid.Locate(point);
    const Points corners = field(Eigen::all, grid.bricks()[brick]);
    EXPECT_LT((corners * WeightsAt(local) - gradient * point).norm(), 1e-12);
    EXPECT_LT((corners * GradientsAt(local).transpose() / grid.edge() - gradient).norm(), 1e-9);
  }
  const Eigen::Vector3d local = grid.Locate(far).local;  // by at most one edge
  EXPECT_LE(local.maxCoeff(), 2);
  EXPECT_GE(local.minCoeff(), -1);
}

// The patch test: a uniform strain loads the corners as its stress loads the faces.
TEST(BrickElement, TurnsAUniformStrainIntoItsTractions) {
  const double edge = 0.014, poisson = 0.3;
  BrickFractions full;
  full.fill(1);
  const BrickMatrix k = BrickElement(edge, poisson).Stiffness(full, 0);
  EXPECT_LT((k - k.transpose()).norm(), 1e-15);
  Eigen::Matrix3d strain;
  strain << 1e-2, 3e-3, -2e-3, 3e-3, -4e-3, 1e-3, -2e-3, 1e-3, 2e-3;
  const double lambda = poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = 1 / (2 * (1 + poisson));
  const Eigen::Matrix3d stress = 2 * mu * strain + lambda * strain.trace() * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 8> corners, turned;
  for (int c = 0; c < 8; ++c) corners.col(c) = edge * Eigen::Vector3d(c & 1, c >> 1 & 1, c >> 2 & 1);
  const Eigen::Matrix<double, 3, 8> forces = (k * (strain * corners).reshaped()).reshaped(3, 8);
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d outward = 2 * corners.col(c) / edge - Eigen::Vector3d::Ones();
    EXPECT_LT((forces.col(c) - edge * edge / 4 * stress * outward).norm(), 1e-12);
    turned.col(c) = Eigen::Vector3d(1, 2, 3).cross(corners.col(c)) + Eigen::Vector3d::Ones();
  }
  EXPECT_LT((k * turned.reshaped()).norm(), 1e-12);  // rigid motions cost nothing
}

// With material in the lower half only, the resultant of the stress is at a quarter of the height.
TEST(BrickElement, CountsOnlyThePartsThatAreMaterial) {
  BrickFractions lower{};
  for (int p = 0; p < kBrickParts / 2; ++p) lower[p] = 1;
  const BrickMatrix k = BrickElement(1, 0).Stiffness(lower, 0);
  Eigen::Matrix<double, 3, 8> squeezed = Eigen::Matrix<double, 3, 8>::Zero();
  for (int c = 0; c < 8; ++c) squeezed(0, c) = c & 1;  // strain 1 along x, stress 1, on half of the face
  const Eigen::Matrix<double, 3, 8> forces = (k * squeezed.reshaped()).reshaped(3, 8);
  EXPECT_NEAR(forces(0, 1) + forces(0, 3), 0.375, 1e-6);
  EXPECT_NEAR(forces(0, 5) + forces(0, 7), 0.125, 1e-6);
}

}  // namespace
}  // namespace phrenic
