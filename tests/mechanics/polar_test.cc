#include "server/mechanics/forces/polar.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

namespace phrenic {
namespace {

template <int N>
Gradient<N> Random(std::mt19937& random, double flat) {
  std::uniform_real_distribution<double> value(-1, 1);
  Gradient<N> f = Gradient<N>::NullaryExpr([&] { return value(random); });
  f.col(1) = flat * f.col(1) + (1 - flat) * f.col(0);
  return f;
}

// R^T R = I and R^T F is symmetric: that is what makes R the rotation of F.
template <int N>
void ExpectPolar(const Gradient<N>& f, const Gradient<N>& r) {
  const Eigen::Matrix<double, N, N> unit = r.transpose() * r, s = r.transpose() * f;
  EXPECT_LT((unit - Eigen::Matrix<double, N, N>::Identity()).norm(), 1e-9) << f;
  EXPECT_LT((s - s.transpose()).norm(), 1e-12 * (1 + f.norm())) << f;
}

TEST(NearestRotation, IsTheRotationOfThePolarDecomposition) {
  std::mt19937 random(5);
  for (const double flat : {1.0, 1e-3, 1e-6}) {
    for (int i = 0; i < 200; ++i) {
      const Gradient<2> triangle = Random<2>(random, flat);
      ExpectPolar<2>(triangle, NearestRotation(triangle));
      const Gradient<3> tetrahedron = Random<3>(random, flat);
      const Gradient<3> r = NearestRotation(tetrahedron);
      ExpectPolar<3>(tetrahedron, r);
      EXPECT_NEAR(r.determinant(), 1, 1e-9);  // also where the element is turned inside out
    }
  }
}

TEST(NearestRotation, OfARotationIsItself) {
  const Gradient<3> turn = Eigen::AngleAxisd(2.5, Eigen::Vector3d(3, 1, -2).normalized()).toRotationMatrix();
  EXPECT_LT((NearestRotation(turn) - turn).norm(), 1e-14);
  const Gradient<2> columns = turn.leftCols<2>();
  EXPECT_LT((NearestRotation(columns) - columns).norm(), 1e-14);
}

TEST(NearestRotation, OfAPointIsFinite) {
  EXPECT_TRUE(NearestRotation(Gradient<2>(Gradient<2>::Zero())).allFinite());
  EXPECT_TRUE(NearestRotation(Gradient<3>(Gradient<3>::Zero())).allFinite());
}

}  // namespace
}  // namespace phrenic
